// The window has the colours of the page.
#include "viewer/gui/theme.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace tureen::viewer {
namespace theme_test {

struct PaletteColor {
  const char* name;  // of the page's variable, without its dashes
  std::uint32_t Palette::*color;
};

constexpr std::array colors = {PaletteColor{"page", &Palette::page},
                               PaletteColor{"card", &Palette::card},
                               PaletteColor{"tint", &Palette::tint},
                               PaletteColor{"line", &Palette::line},
                               PaletteColor{"edge", &Palette::edge},
                               PaletteColor{"ink", &Palette::ink},
                               PaletteColor{"faint", &Palette::faint},
                               PaletteColor{"accent", &Palette::accent},
                               PaletteColor{"on-accent", &Palette::on_accent},
                               PaletteColor{"accent-tint", &Palette::accent_tint},
                               PaletteColor{"danger", &Palette::danger},
                               PaletteColor{"danger-tint", &Palette::danger_tint}};

/// The variables of a block of the page's style sheet: "--name: #rrggbb;".
std::uint32_t variable(const std::string& block, const std::string& name) {
  std::smatch found;
  if (!std::regex_search(block, found, std::regex("--" + name + ": #([0-9a-f]{6});"))) {
    ADD_FAILURE() << "palette.css has no --" << name;
    return 0;
  }
  return std::uint32_t(std::stoul(found[1], nullptr, 16));
}

TEST(Theme, HasTheColoursOfThePage) {
  std::ifstream file(TUREEN_SOURCE_DIR "/web/page/style/palette.css");
  const std::string css{std::istreambuf_iterator<char>(file), {}};
  const std::size_t dark = css.find("prefers-color-scheme: dark");
  ASSERT_NE(dark, std::string::npos);
  for (const PaletteColor& each : colors) {
    EXPECT_EQ(palette(Theme::light).*each.color, variable(css.substr(0, dark), each.name))
        << each.name;
    EXPECT_EQ(palette(Theme::dark).*each.color, variable(css.substr(dark), each.name)) << each.name;
  }
}

TEST(Theme, ListsEveryColour) { EXPECT_EQ(colors.size(), sizeof(Palette) / sizeof(std::uint32_t)); }

}  // namespace theme_test
}  // namespace tureen::viewer
