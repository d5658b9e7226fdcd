#include "viewer/gui/font.hpp"

#include <imgui/imgui.h>
#include <stb/stb_truetype.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/input.hpp"
#include "base/platform/process.hpp"

namespace tureen::viewer {

namespace {

/// Paths. `bold` may be missing on the machine.
struct FontFiles {
  std::string regular, bold;
};

/// The fixed font comes first.
const std::vector<FontFiles>& known_fonts() {
  static const std::vector<FontFiles> fonts = [] {
    std::vector<FontFiles> all;
    const auto add = [&all](const std::string& folder, const char* regular, const char* bold) {
      all.push_back({folder + regular, folder + bold});
    };
    // Debian, Arch, Fedora.
    for (const char* folder : {"/usr/share/fonts/truetype/dejavu/", "/usr/share/fonts/TTF/",
                               "/usr/share/fonts/dejavu-sans-fonts/"})
      add(folder, "DejaVuSans.ttf", "DejaVuSans-Bold.ttf");
    for (const char* folder : {"/usr/share/fonts/truetype/noto/", "/usr/share/fonts/noto/"})
      add(folder, "NotoSans-Regular.ttf", "NotoSans-Bold.ttf");
    for (const char* folder :
         {"/usr/share/fonts/truetype/liberation/", "/usr/share/fonts/liberation-sans/"})
      add(folder, "LiberationSans-Regular.ttf", "LiberationSans-Bold.ttf");
    add("/System/Library/Fonts/Supplemental/", "Arial.ttf", "Arial Bold.ttf");
    add("C:/Windows/Fonts/", "segoeui.ttf", "segoeuib.ttf");
    return all;
  }();
  return fonts;
}

/// Fontconfig's default font, if the machine has fontconfig's programs.
FontFiles fontconfig_font() {
  return {output_of("fc-match", {"-f", "%{file}", "sans-serif:fontformat=TrueType"}),
          output_of("fc-match", {"-f", "%{file}", "sans-serif:bold:fontformat=TrueType"})};
}

/// Height of a line, in em squares; nullopt if the file is missing or has no usable font. Dear
/// ImGui measures fonts by this height, which differs between fonts, and asserts that they are
/// usable.
std::optional<double> line_height(const std::string& path) {
  std::error_code ignored;
  if (path.empty() || !std::filesystem::is_regular_file(path, ignored)) return {};
  std::vector<std::byte> bytes;
  try {
    bytes = Input::open(path).read_rest();
  } catch (const Error&) {
    return {};
  }
  stbtt_fontinfo font;
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  // The offset is negative for a file that is no font.
  const int offset = bytes.size() < 12 ? -1 : stbtt_GetFontOffsetForIndex(data, 0);
  if (offset < 0 || !stbtt_InitFont(&font, data, offset)) return {};
  const double em = stbtt_ScaleForMappingEmToPixels(&font, 1);
  const double height = stbtt_ScaleForPixelHeight(&font, 1);
  if (!(height > 0 && em / height > 0.5 && em / height < 4)) return {};  // a damaged file
  return em / height;
}

// Latin, Greek, Cyrillic, and the punctuation of our texts: names come from files. Pairs of first
// and last, ended by 0. Static, because Dear ImGui keeps the pointer.
constexpr ImWchar letters[] = {0x20,   0x17f,  0x370,  0x3ff,  0x400, 0x45f,
                               0x2010, 0x2027, 0x2212, 0x2212, 0};
constexpr ImWchar heading_letters[] = {0x20, 0x17f, 0};

/// Returns whether the file has a font.
bool add(ImFontAtlas& atlas, const std::string& path, const FontSize& size, const ImWchar* range) {
  const std::optional<double> height = line_height(path);
  if (!height) return false;
  ImFontConfig config;
  config.OversampleH = 2;
  const auto pixels = static_cast<float>(size.points * size.scale * *height);
  return atlas.AddFontFromFileTTF(path.c_str(), pixels, &config, range) != nullptr;
}

bool add(ImFontAtlas& atlas, const FontFiles& files, const FontSize& size) {
  if (!add(atlas, files.regular, size, letters)) return false;
  for (const double relative : {1.0, 1.5}) {
    const FontSize of_heading{relative * size.points, size.scale};
    if (!add(atlas, files.bold, of_heading, heading_letters))
      add(atlas, files.regular, of_heading, heading_letters);
  }
  return true;
}

}  // namespace

void add_fonts(ImFontAtlas& atlas, FontChoice choice, const FontSize& size) {
  if (choice == FontChoice::fixed) {
    if (add(atlas, known_fonts().front(), size)) return;
  } else {
    for (const FontFiles& files : known_fonts())
      if (add(atlas, files, size)) return;
    if (add(atlas, fontconfig_font(), size)) return;
  }
  ImFontConfig config;
  config.SizePixels = static_cast<float>(13 * size.scale);
  atlas.AddFontDefault(&config);
}

}  // namespace tureen::viewer
