#include "base/platform/file_lock.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>

#include "base/error.hpp"

namespace tureen {
namespace file_lock_test {

namespace fs = std::filesystem;

TEST(FileLocks, AreHeldOnceAndLeaveNoFile) {
  const fs::path file = fs::path(testing::TempDir()) / "held.lock";
  std::ofstream(file) << "left by a killed process";
  std::optional<FileLock> first(file);
  EXPECT_TRUE(first->is_held());
  {
    const FileLock second(file);
    EXPECT_FALSE(second.is_held());
  }
  EXPECT_TRUE(fs::exists(file)) << "the second lock removed the first";
  first.reset();
  EXPECT_FALSE(fs::exists(file));
  EXPECT_TRUE(FileLock(file).is_held());
}

TEST(FileLocks, NeedAFolder) { EXPECT_THROW(FileLock("/no/such/folder/lock"), OutputError); }

}  // namespace file_lock_test
}  // namespace tureen
