// Keys and what they change.
#include "viewer/shortcuts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <utility>

#include "viewer/state.hpp"

namespace tureen::viewer {
namespace shortcuts_test {

TEST(Shortcuts, EachKeyHasOneMeaning) {
  std::set<std::pair<Key, With>> keys;
  for (const Shortcut& each : shortcuts())
    EXPECT_TRUE(keys.insert({each.key, each.with}).second) << each.text;
}

/// The lines of the page's table: key -> meaning.
std::map<std::string, std::string> page_keys() {
  std::ifstream file(TUREEN_SOURCE_DIR "/web/page/viewer_page.ts");
  const std::string source{std::istreambuf_iterator<char>(file), {}};
  const std::regex line("\\{ key: '(.)', meaning: '([^']*)'");
  std::map<std::string, std::string> keys;
  for (std::sregex_iterator each(source.begin(), source.end(), line), end; each != end; ++each)
    keys[(*each)[1]] = (*each)[2];
  return keys;
}

TEST(Shortcuts, HaveTheWordsOfThePage) {
  const auto keys = page_keys();
  ASSERT_GE(keys.size(), 12u) << "the page's table has another form";
  for (const auto& [name, meaning] : keys) {
    // K adds to the camera path, which the page lacks; the page has links; ? is no key.
    if (name == "k" || name == "l" || name == "?") continue;
    const std::string upper(1, char(std::toupper(static_cast<unsigned char>(name.front()))));
    const auto found = std::find_if(shortcuts().begin(), shortcuts().end(), [&](const auto& each) {
      return each.with == With::nothing && name_of(each.key) == upper;
    });
    ASSERT_NE(found, shortcuts().end()) << upper;
    ASSERT_NE(found->text, nullptr) << upper;
    EXPECT_EQ(found->text, meaning) << upper;
  }
}

TEST(Shortcuts, EscapeClosesTheTopmostList) {
  State state;
  state.show_keys = state.show_files = true;
  ASSERT_TRUE(run_shortcut(Key::escape, With::nothing, state));
  EXPECT_FALSE(state.show_keys);
  EXPECT_TRUE(state.show_files);
  ASSERT_TRUE(run_shortcut(Key::escape, With::nothing, state));
  EXPECT_FALSE(state.show_files);
}

TEST(Shortcuts, ITurnsTheSceneUpsideDown) {
  State state;
  const glm::dvec3 up(0, 0, 1);
  state.controls.set_up(up);
  ASSERT_TRUE(run_shortcut(Key::i, With::nothing, state));
  EXPECT_EQ(state.controls.up(), -up);
  ASSERT_TRUE(run_shortcut(Key::i, With::nothing, state));
  EXPECT_EQ(state.controls.up(), up);
}

TEST(Shortcuts, RRestoresTheUpAxis) {
  State state;
  const glm::dvec3 up = state.controls.up();
  ASSERT_TRUE(run_shortcut(Key::u, With::nothing, state));
  ASSERT_NE(state.controls.up(), up);
  ASSERT_TRUE(run_shortcut(Key::r, With::nothing, state));
  EXPECT_EQ(state.controls.up(), up);
}

TEST(Shortcuts, ThatMessagesNameExist) {
  // "press K to add ..", "reload (F5)"
  const std::regex named("\"[^\"\\n]*(?:press |\\()(F[0-9]+|[A-Z])(?: |\\))[^\"\\n]*\"");
  std::size_t found = 0;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(TUREEN_SOURCE_DIR "/viewer")) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream file(entry.path());
    const std::string source{std::istreambuf_iterator<char>(file), {}};
    for (std::sregex_iterator each(source.begin(), source.end(), named), end; each != end; ++each) {
      const std::optional<Key> key = key_named((*each)[1].str());
      EXPECT_TRUE(
          key && std::ranges::any_of(shortcuts(), [&](const Shortcut& s) { return s.key == *key; }))
          << entry.path() << ": " << each->str();
      ++found;
    }
  }
  EXPECT_GT(found, 0u);
}

}  // namespace shortcuts_test
}  // namespace tureen::viewer
