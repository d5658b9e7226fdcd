// A changed file is reported once, after its writer has finished.
#include "viewer/files/file_watch.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace tureen::viewer {
namespace file_watch_test {

namespace fs = std::filesystem;

/// A file in an empty folder.
fs::path fresh_file() {
  const fs::path folder =
      fs::path(testing::TempDir()) / testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::remove_all(folder);
  fs::create_directories(folder);
  std::ofstream(folder / "scene.glb") << "one";
  return folder / "scene.glb";
}

void append(const fs::path& file) { std::ofstream(file, std::ios::app) << "more"; }

TEST(FileWatch, AChangeIsToldOnceWhenItIsOver) {
  const fs::path file = fresh_file();
  FileWatch watch(file);
  EXPECT_FALSE(watch.changed());
  append(file);
  EXPECT_FALSE(watch.changed()) << "the writer may not have finished";
  append(file);
  EXPECT_FALSE(watch.changed()) << "it changed again";
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changed()) << "reported twice";
}

TEST(FileWatch, AFileThatIsReplacedOrGoneAndBackIsAChange) {
  const fs::path file = fresh_file();
  FileWatch watch(file);
  fs::remove(file);
  EXPECT_FALSE(watch.changed());
  EXPECT_FALSE(watch.changed()) << "the file is missing";
  std::ofstream(file) << "another";
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
}

TEST(FileWatch, AFolderIsWatchedByItsFiles) {
  const fs::path file = fresh_file();
  FileWatch watch(file.parent_path());
  std::ofstream(file.parent_path() / "new.png") << "x";
  EXPECT_FALSE(watch.changed());
  EXPECT_TRUE(watch.changed());
}

}  // namespace file_watch_test
}  // namespace tureen::viewer
