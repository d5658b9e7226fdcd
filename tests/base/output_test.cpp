// Files are complete or absent, and keep what belongs to the file that they replace.
#include "base/output.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/platform/system.hpp"

namespace tureen {
namespace output_test {

namespace fs = std::filesystem;

class OutputFile : public testing::Test {
 protected:
  OutputFile()
      : folder(fs::path(testing::TempDir()) /
               (std::string("tureen_output_") +
                testing::UnitTest::GetInstance()->current_test_info()->name())),
        file(folder / "scene.glb") {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  ~OutputFile() override { fs::remove_all(folder); }

  std::string content() const {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::ptrdiff_t names() const {
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
  }

  fs::path folder, file;
};

TEST_F(OutputFile, RemovesWhatKilledProcessesLeft) {
  // Linux numbers processes up to 4,194,304.
  const std::string own = std::to_string(process_id());
  for (const std::string& kept :
       {"scene.glb.tmp" + own + "-99", std::string("other.glb.tmp999999999-0"),
        std::string("scene.glb.tmp999999999"), std::string("scene.glb.tmp999999999-0.old"),
        std::string("scene.glb.tmp999999999-0.tmp999999999-0")})
    std::ofstream(folder / kept) << "x";
  std::ofstream(file) << "old";
  std::ofstream(folder / "scene.glb.tmp999999999-0") << "x";
  fs::create_directories(folder / "scene.glb.tmp999999998-12/images");
  const auto age = [&](const char* name) {
    fs::last_write_time(folder / name, fs::file_time_type::clock::now() - std::chrono::hours(2));
  };
  age("scene.glb.tmp999999999-0");
  age("scene.glb.tmp999999998-12");
  std::ofstream(folder / "scene.glb.tmp999999997-0") << "young: perhaps of another computer";
  write_file(file, "new");
  EXPECT_EQ(content(), "new");
  EXPECT_EQ(names(), 7);
  EXPECT_FALSE(fs::exists(folder / "scene.glb.tmp999999999-0"));
  EXPECT_FALSE(fs::exists(folder / "scene.glb.tmp999999998-12"));
}

TEST_F(OutputFile, IsThereOnceItIsCommitted) {
  {
    Output output(file);
    output.write("abc");
    output.write_value(std::uint16_t(0x3231));
    EXPECT_EQ(output.position(), 5u);
    EXPECT_FALSE(fs::exists(file));
    output.commit();
  }
  EXPECT_EQ(content(), "abc12");
  EXPECT_EQ(names(), 1);
}

TEST_F(OutputFile, LeavesNothingWithoutACommit) {
  write_file(file, "old");
  {
    Output output(file);
    output.write("new");
    EXPECT_EQ(names(), 2);
  }
  EXPECT_EQ(content(), "old");
  EXPECT_EQ(names(), 1);
}

TEST_F(OutputFile, KeepsThePermissionsOfTheFileThatItReplaces) {
  write_file(file, "old");
  // No umask gives a new file the right to execute.
  const fs::perms own = fs::perms::owner_all | fs::perms::group_exec;
  fs::permissions(file, own);
  write_file(file, "new");
  EXPECT_EQ(content(), "new");
  EXPECT_EQ(fs::status(file).permissions(), own);
}

TEST_F(OutputFile, FailsWhereNoFileCanBe) {
  EXPECT_THROW(Output(folder / "missing" / "scene.glb"), OutputError);
  EXPECT_THROW(write_file(folder, "a folder"), OutputError);
  EXPECT_EQ(names(), 0);
}

}  // namespace output_test
}  // namespace tureen
