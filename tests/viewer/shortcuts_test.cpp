// Keys and what they change.
#include "viewer/input/shortcuts.hpp"

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "viewer/state.hpp"

namespace tureen::viewer {
namespace shortcuts_test {

TEST(Shortcuts, EachKeyHasOneMeaning) {
  std::set<std::pair<Key, bool>> keys;
  for (const Shortcut& each : shortcuts())
    EXPECT_TRUE(keys.insert({each.key, each.control}).second) << each.text;
}

TEST(Shortcuts, ITurnsTheSceneUpsideDown) {
  State state;
  const glm::dvec3 up(0, 0, 1);
  state.controls.set_up(up);
  ASSERT_TRUE(run_shortcut(Key::i, false, state));
  EXPECT_EQ(state.controls.up(), -up);
  ASSERT_TRUE(run_shortcut(Key::i, false, state));
  EXPECT_EQ(state.controls.up(), up);
}

}  // namespace shortcuts_test
}  // namespace tureen::viewer
