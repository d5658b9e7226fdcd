// Settings stored between runs.
#include "viewer/files/settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "base/error.hpp"
#include "tests/support/errors.hpp"

namespace tureen::viewer {
namespace settings_test {

namespace fs = std::filesystem;

fs::path folder() {
  fs::path path =
      fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(path);
  fs::create_directories(path);
  return path;
}

TEST(Settings, ComeBackAsTheyWereLeft) {
  const fs::path file = folder() / "tureen" / "viewer.json";
  Settings settings{.theme = Theme::light,
                    .window = {999, 777},
                    .vsync = false,
                    .smooth_motion = false,
                    .smooth_at_rest = false,
                    .recent = {},
                    .images = "/some where"};
  remember(settings, "/b.glb");
  remember(settings, "/a folder/");
  remember(settings, "/b.glb");
  write_settings(settings, file);
  const Settings read = read_settings(file);
  EXPECT_EQ(read.theme, Theme::light);
  EXPECT_EQ(read.window, settings.window);
  EXPECT_EQ(read.vsync, false);
  EXPECT_EQ(read.smooth_motion, false);
  EXPECT_EQ(read.smooth_at_rest, false);
  EXPECT_EQ(read.images, "/some where");
  EXPECT_THAT(read.recent, testing::ElementsAre("/b.glb", "/a folder"))
      << "newest first, no duplicates";
}

TEST(Settings, OnlyTheNewestScenesAreRemembered) {
  Settings settings;
  for (int i = 0; i < 40; ++i) remember(settings, "/" + std::to_string(i));
  ASSERT_EQ(settings.recent.size(), most_recent);
  EXPECT_EQ(settings.recent.front(), "/39");
}

TEST(Settings, WithoutAFileThereAreDefaults) {
  EXPECT_EQ(read_settings(folder() / "none.json").window, Settings{}.window);
}

TEST(Settings, AWindowIsOneThatCanBeSeenAndThatScreensHold) {
  const fs::path file = folder() / "viewer.json";
  const auto window = [&](const char* sides) {
    std::ofstream(file) << "{\"window\": " << sides << "}";
    return read_settings(file).window;
  };
  EXPECT_EQ(window("[640.5, 480]"), glm::ivec2(640, 480));
  EXPECT_EQ(window("[-1, 0]"), glm::ivec2(320, 240));
  // The lower 32 of its 64 bits are 640.
  EXPECT_EQ(window("[4294967936, 1e30]"), glm::ivec2(16384, 16384));
}

TEST(Settings, AFileThatIsNotOursIsRefusedWithItsName) {
  const fs::path file = folder() / "viewer.json";
  for (const char* text : {"[1]", "{\"vsync\": 3}", "{\"recent\": [1]}", "{\"theme\": \"red\"}",
                           "{\"window\": [1]}", "{\"window\": [1e300, 1]}", "{"}) {
    std::ofstream(file) << text;
    EXPECT_THAT(test::error_of([&] { read_settings(file); }), test::ErrorIn("viewer.json")) << text;
  }
}

TEST(Settings, LieWhereTheEnvironmentSays) {
  ::setenv("XDG_CONFIG_HOME", "/somewhere/config", 1);
  EXPECT_EQ(settings_file(), std::optional<fs::path>("/somewhere/config/tureen/viewer.json"));
  ::setenv("XDG_CONFIG_HOME", "relative", 1);
  ::setenv("HOME", "/home/someone", 1);
  EXPECT_EQ(settings_file(), std::optional<fs::path>("/home/someone/.config/tureen/viewer.json"));
}

}  // namespace settings_test
}  // namespace tureen::viewer
