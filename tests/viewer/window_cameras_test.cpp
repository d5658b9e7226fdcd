// Photographs without cameras that are dropped on the window, with a stand-in for COLMAP.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "base/output.hpp"
#include "base/platform/process.hpp"
#include "formats/dataset/dataset.hpp"
#include "tests/viewer/window_fixture.hpp"

namespace tureen::test {
namespace window_test {

class WindowCameras : public Window {
 protected:
  void SetUp() override {
    if (!is_on_path("python3")) GTEST_SKIP() << "the stand-in for COLMAP needs python3";
    fs::create_directories(folder_ / "bin");
    fs::create_symlink(TUREEN_SOURCE_DIR "/tests/jobs/cameras/colmap_stand_in.py",
                       folder_ / "bin/colmap");
    const char* const path = std::getenv("PATH");
    ::setenv("PATH", ((folder_ / "bin").string() + ":" + path).c_str(), 1);
    ::setenv("STAND_IN_LOG", (folder_ / "calls").c_str(), 1);
    ::setenv("STAND_IN", "", 1);
  }

  void take(int count) const {
    fs::create_directories(folder_ / "photos");
    for (int i = 0; i < count; ++i)
      write_file(folder_ / "photos" / ("p" + std::to_string(i) + ".png"),
                 encode_png(Image8(64, 48, glm::u8vec4(20 * i, 100, 100, 255))));
  }
};

TEST_F(WindowCameras, AreFoundAndOfferedForTraining) {
  take(12);
  Person person({1000, 700});
  person.wait().drop("photos").look("asked").click("Find the cameras").look("found");
  const ChildResult result = replay(person.click("Cancel").press(Key::digit_1).look("open"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Dataset dataset = read_dataset(folder_ / "photos.dataset");
  EXPECT_EQ(dataset.train.size() + dataset.test.size(), 12u);
  EXPECT_NE(image("found").pixels, image("asked").pixels);
  EXPECT_NE(image("found").pixels, image("open").pixels);

  // The cameras are known the next time.
  fs::remove(folder_ / "calls");
  Person again({1000, 700});
  const ChildResult opened = replay(again.wait().drop("photos").wait().click("Cancel"));
  EXPECT_EQ(opened.exit_code, 0) << opened.err;
  EXPECT_FALSE(fs::exists(folder_ / "calls"));
}

TEST_F(WindowCameras, CancelEndsTheSearch) {
  take(12);
  ::setenv("STAND_IN", "slow=feature_extractor", 1);
  Person person({1000, 700});
  person.wait().point({200, 300}).look("before").drop("photos").wait();
  person.click_at_once("Find the cameras").hold(Key::super, 0.1).click("Cancel");
  const ChildResult result = replay(person.point({200, 300}).without_notes().look("after"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  expect_equal(image("after"), image("before"));
  EXPECT_FALSE(is_dataset(folder_ / "photos.dataset"));
  std::ifstream file(folder_ / "calls");
  const std::string calls{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(calls, testing::HasSubstr("feature_extractor"));
  EXPECT_EQ(std::count(calls.begin(), calls.end(), '\n'), 1) << calls;
}

TEST_F(WindowCameras, ThatAreNotTrustedWriteNoDataset) {
  take(4);  // too few
  Person person({1000, 700});
  const ChildResult result =
      replay(person.wait().drop("photos").wait().click("Find the cameras").look("refused"));
  EXPECT_EQ(result.exit_code, 1) << "the window shows the error at the end";
  EXPECT_THAT(result.err, testing::HasSubstr("4 photographs are too few"));
  EXPECT_FALSE(fs::exists(folder_ / "photos.dataset"));
}

TEST_F(WindowCameras, AreNotWrittenToAFolderOfOthers) {
  take(12);
  fs::create_directories(folder_ / "photos.dataset");
  write_file(folder_ / "photos.dataset/letter.txt", "x");
  Person person({1000, 700});
  const ChildResult result =
      replay(person.wait().drop("photos").wait().click("Find the cameras").click("Cancel"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(fs::exists(folder_ / "calls"));
}

}  // namespace window_test
}  // namespace tureen::test
