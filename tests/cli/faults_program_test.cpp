// What is on the disk after writing has failed or was cut short: the file that was there before, or
// the new one, whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <map>
#include <random>
#include <sstream>
#include <thread>

#include "cli/nobody.hpp"
#include "cli/program_fixture.hpp"
#include "support/measured.hpp"

namespace tureen {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using test::ChildResult;
using test::Nobody;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

/// Children that start meanwhile cannot write a file beyond so many bytes: to them the disk is
/// full.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

class Faults : public test::Program {
 protected:
  /// Hills of two triangles a cell; other ones for another seed.
  void write_hills(const std::string& name, int cells, int seed) const {
    std::ostringstream off;
    const int side = cells + 1;
    off << "COFF\n" << side * side << ' ' << 2 * cells * cells << " 0\n";
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) off << x << ' ' << y << ' ' << (x * y + seed) % 7 << '\n';
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x) {
        const int v = y * side + x;
        off << "3 " << v << ' ' << v + 1 << ' ' << v + side << " 255 " << (x + seed) % 256
            << " 0\n3 " << v + 1 << ' ' << v + side + 1 << ' ' << v + side << " 0 " << y % 256
            << " 255\n";
      }
    write(name, off.str());
  }

  std::string bytes(const fs::path& path) const {
    std::ifstream stream(folder / path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  /// A file's bytes by "", or those of a folder's files by their names.
  std::map<std::string, std::string> contents(const std::string& name) const {
    if (!fs::is_directory(folder / name)) return {{"", bytes(name)}};
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(folder / name))
      files[entry.path().filename().string()] = bytes(name / entry.path().filename());
    return files;
  }

  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      result.push_back(fs::relative(entry.path(), folder).string());
    return result;
  }

  void put(const std::string& from, const std::string& to) const {
    fs::remove_all(folder / to);
    fs::copy(folder / from, folder / to, fs::copy_options::recursive);
  }

  void remove_temporaries() const {
    for (const std::string& name : names())
      if (name.find(".tmp") != std::string::npos) fs::remove_all(folder / name);
  }
};

TEST_F(Faults, AFullDiskLeavesWhatWasThere) {
  write_hills("large.off", 100, 0);
  write_scene();
  const auto expect = [&](const std::string& output, const std::vector<std::string>& arguments,
                          rlim_t room) {
    SCOPED_TRACE(output);
    const auto before = contents(output);
    ChildResult result;
    {
      const SmallDisk small(room);
      result = run(arguments);
    }
    EXPECT_EQ(result.exit_code, 5) << result.err;
    EXPECT_THAT(result.err, HasSubstr(output));
    EXPECT_THAT(result.err, HasSubstr("File too large"));  // what the system says then
    EXPECT_EQ(contents(output), before);
    EXPECT_THAT(names(), Each(Not(HasSubstr(".tmp"))));
  };
  for (const std::string output : {"out.glb", "out.ply", "out.off", "export/"}) {
    ASSERT_EQ(run({"convert", "scene.off", output}).exit_code, 0);
    expect(output, {"convert", "large.off", output, "--force"}, 20000);
  }
  // So small that it fails when the last of it is flushed.
  expect("out.ply", {"convert", "scene.off", "out.ply", "--force"}, 200);
}

TEST_F(Faults, WhereNothingMayBeWrittenNothingIs) {
  write_scene();
  fs::create_directory(folder / "locked");
  ASSERT_EQ(run({"convert", "scene.off", "locked/out.glb"}).exit_code, 0);
  const auto before = contents("locked");
  fs::permissions(folder, fs::perms::all);
  fs::permissions(folder / "scene.off", fs::perms(0644));
  test::make_streams_for_all(folder);
  fs::permissions(folder / "locked/out.glb", fs::perms(0666));  // it is the folder that forbids
  fs::permissions(folder / "locked", fs::perms(0555));
  std::vector<ChildResult> results;
  {
    const Nobody nobody;
    if (::eaccess(TUREEN_PROGRAM, X_OK) != 0)
      GTEST_SKIP() << TUREEN_PROGRAM << " is not for everybody";
    for (const char* output : {"locked/out.glb", "locked/out.ply", "locked/export/"})
      results.push_back(run({"convert", "scene.off", output, "--force"}));
  }
  fs::permissions(folder / "locked", fs::perms::owner_all);
  for (const ChildResult& result : results) {
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_THAT(result.err, HasSubstr("cannot be created: Permission denied"));
  }
  EXPECT_EQ(contents("locked"), before);
}

/// Ends conversions over an old file at moments from their beginning to their end.
TEST_F(Faults, ASignalAtAnyMomentLeavesTheOldOrTheNewWhole) {
  write_hills("old.off", 40, 0);
  write_hills("new.off", 120, 1);
  std::minstd_rand random(7);
  for (const std::string output : {"out.glb", "export"}) {
    const bool is_folder = output == "export";
    const auto target = [&](const std::string& name) { return is_folder ? name + "/" : name; };
    const std::string old_output = "old_" + output, new_output = "new_" + output;
    fs::create_directories(folder / "a");
    fs::create_directories(folder / "b");
    // The name is in the file.
    ASSERT_EQ(run({"convert", "old.off", target("a/" + output)}).exit_code, 0);
    const Clock::time_point begin = Clock::now();
    ASSERT_EQ(run({"convert", "new.off", target("b/" + output)}).exit_code, 0);
    const auto whole = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - begin);
    const auto before = contents("a/" + output), after = contents("b/" + output);
    ASSERT_NE(before, after);
    for (const int signal : {SIGKILL, SIGINT}) {
      constexpr int sent = 16;
      int cut_short = 0, replaced = 0;
      for (int i = 0; i < sent; ++i) {
        put("a/" + output, output);
        // Half of them early: the run that was timed may have been a slow one.
        const auto latest = whole.count() >> (i % 4);
        const auto moment = std::chrono::microseconds(i == 0 ? 0 : random() % latest);
        test::Child child({"convert", "new.off", target(output), "--force"}, folder);
        std::this_thread::sleep_for(moment);
        child.signal(signal);
        const ChildResult result = child.wait();
        const auto now = contents(output);
        EXPECT_TRUE(now == before || now == after)
            << output << " after signal " << signal << " at " << moment.count() << " us";
        replaced += now == after;
        if (result.exit_code == 0) {
          EXPECT_EQ(now, after);
          continue;
        }
        ++cut_short;
        if (signal == SIGKILL) {
          remove_temporaries();  // nobody else could
        } else {
          EXPECT_THAT(names(), Each(Not(HasSubstr(".tmp"))));
          if (result.exit_code != -1) {  // which is before anything was made
            EXPECT_EQ(result.exit_code, 5) << result.err;
            EXPECT_THAT(result.err, HasSubstr("interrupted"));
          }
        }
      }
      EXPECT_GT(cut_short, 0) << "no moment was early enough";
      const std::string name = signal == SIGKILL ? "SIGKILL" : "SIGINT";
      test::leave_measured(
          "signal-" + output + "-" + name,
          {{"what", "convert over " + std::string(is_folder ? "a folder" : "a file")},
           {"signal", name},
           {"sent", sent},
           {"cut_short", cut_short},
           {"old", sent - replaced},
           {"new", replaced}});
    }
  }
}

}  // namespace
}  // namespace tureen
