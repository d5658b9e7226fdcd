// The disk after a failed or interrupted write: the old file or the new one, complete.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <random>
#include <sstream>

#include "tests/cli/faults.hpp"
#include "tests/cli/nobody.hpp"
#include "tests/cli/program_fixture.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/measured.hpp"

namespace tureen {
namespace faults_program_test {

using test::Names;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using test::ChildResult;
using test::Moment;
using test::Nobody;
using test::SmallDisk;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

class Faults : public test::Program {
 protected:
  /// Writes hills with two triangles a cell; each seed gives other hills.
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

  std::map<std::string, std::string> contents(const std::string& name) const {
    return test::contents_of(folder / name);
  }
  std::vector<std::string> names() const { return test::names_in(folder); }

  void put(const std::string& from, const std::string& to) const {
    fs::remove_all(folder / to);
    fs::copy(folder / from, folder / to, fs::copy_options::recursive);
  }

  /// Ends conversions over an old file at moments from their start to beyond their end; for each
  /// signal and output, `timed` moments at any time, and those of two events.
  void expect_survival(int timed);
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
    EXPECT_THAT(result.err, Names(output, "File too large"));  // the system's message
    EXPECT_EQ(contents(output), before);
    EXPECT_THAT(names(), Each(Not(HasSubstr(".tmp"))));
  };
  for (const std::string output : {"out.glb", "out.ply", "out.off", "export/"}) {
    ASSERT_EQ(run({"convert", "scene.off", output}).exit_code, 0);
    expect(output, {"convert", "large.off", output, "--force"}, 20000);
  }
  // This limit is so small that the last flush fails.
  expect("out.ply", {"convert", "scene.off", "out.ply", "--force"}, 200);

  // Images: a single one, the first of several, and their contact sheet, which is larger than each.
  const std::vector<std::string> orbit{"render",  "scene.off", "--size", "160x120",
                                       "--orbit", "3",         "-o",     "view_%d.png"};
  ASSERT_EQ(run({"render", "scene.off", "-o", "picture.png"}).exit_code, 0);
  ASSERT_EQ(run(orbit).exit_code, 0);
  const auto views = [&] {
    return std::array{contents("view_0.png"), contents("view_1.png"), contents("view_2.png")};
  };
  const auto before = views();
  expect("picture.png", {"render", "large.off", "-o", "picture.png"}, 1000);
  expect("view_0.png", {"render", "large.off", "--orbit", "3", "-o", "view_%d.png"}, 1000);
  EXPECT_EQ(views(), before);
  std::uintmax_t largest = 0;
  for (int i = 0; i < 3; ++i)
    largest = std::max(largest, fs::file_size(folder / ("view_" + std::to_string(i) + ".png")));
  ASSERT_GT(fs::file_size(folder / "contact_sheet.png"), largest);
  expect("contact_sheet.png", orbit, largest);
  EXPECT_EQ(views(), before) << "the same images again, complete";
}

TEST_F(Faults, ADiskWithoutSpaceLeavesWhatWasThere) {
  write_hills("large.off", 100, 0);
  write_scene();
  fs::create_directory(folder / "disk");
  for (const std::string output : {"disk/out.glb", "disk/out.ply", "disk/export/"})
    ASSERT_EQ(run({"convert", "scene.off", output}).exit_code, 0);
  for (const std::string output : {"disk/out.glb", "disk/out.ply", "disk/export/"}) {
    const ChildResult result =
        test::run_on_disk(80, {"convert", "large.off", output, "--force"}, folder);
    if (result.exit_code == test::no_disk)
      GTEST_SKIP() << "cannot mount a small disk: " << result.err;
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_THAT(result.err, Names("No space left on device"));
    EXPECT_EQ(test::names_in(folder / "after"), test::names_in(folder / "disk")) << output;
    for (const char* file : {"out.glb", "out.ply", "export"})
      EXPECT_EQ(contents("after/" + std::string(file)), contents("disk/" + std::string(file)))
          << output;
  }
}

TEST_F(Faults, WhereNothingMayBeWrittenNothingIs) {
  write_scene();
  fs::create_directory(folder / "locked");
  ASSERT_EQ(run({"convert", "scene.off", "locked/out.glb"}).exit_code, 0);
  const auto before = contents("locked");
  fs::permissions(folder, fs::perms::all);
  fs::permissions(folder / "scene.off", fs::perms(0644));
  test::make_streams_for_all(folder);
  fs::permissions(folder / "locked/out.glb", fs::perms(0666));  // only the folder forbids writing
  fs::permissions(folder / "locked", fs::perms(0555));
  std::vector<ChildResult> results;
  {
    const Nobody nobody;
    if (::eaccess(TUREEN_PROGRAM, X_OK) != 0)
      GTEST_SKIP() << TUREEN_PROGRAM << " is not executable for every user";
    for (const char* output : {"locked/out.glb", "locked/out.ply", "locked/export/"})
      results.push_back(run({"convert", "scene.off", output, "--force"}));
  }
  fs::permissions(folder / "locked", fs::perms::owner_all);
  for (const ChildResult& result : results) {
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_THAT(result.err, Names("Permission denied"));
  }
  EXPECT_EQ(contents("locked"), before);
}

/// The events of a folder and of the names beside it, in order.
class Watch {
 public:
  explicit Watch(const fs::path& folder)
      : events_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)),
        beside_(::inotify_add_watch(events_, folder.parent_path().c_str(), changes)),
        inside_(::inotify_add_watch(events_, folder.c_str(), changes | IN_MODIFY)),
        name_(folder.filename().string()) {}
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  ~Watch() { ::close(events_); }

  bool watches() const { return beside_ >= 0 && inside_ >= 0; }

  /// One letter an event. `+`: the folder's name appears. `-`: the folder's name disappears. `i`:
  /// changes inside the original folder, whatever its current name.
  std::string changes_seen() {
    std::string seen;
    alignas(inotify_event) char bytes[4096];
    for (ssize_t size; (size = ::read(events_, bytes, sizeof bytes)) > 0;)
      for (ssize_t at = 0; at < size;) {
        const auto* event = reinterpret_cast<const inotify_event*>(bytes + at);
        at += ssize_t(sizeof(inotify_event) + event->len);
        const bool is_name = event->wd == beside_ && event->len > 0 && event->name == name_;
        if (is_name) seen += event->mask & (IN_CREATE | IN_MOVED_TO) ? '+' : '-';
        const bool is_inside = event->wd == inside_ && (event->mask & (changes | IN_MODIFY));
        if (is_inside && !seen.ends_with('i')) seen += 'i';
      }
    return seen;
  }

 private:
  static constexpr std::uint32_t changes = IN_CREATE | IN_DELETE | IN_MOVED_FROM | IN_MOVED_TO;
  int events_, beside_, inside_;
  std::string name_;
};

// An exchange reports the new folder first, then the removal of the old one. If the program removed
// or moved the old one first, its removal would come first.
TEST_F(Faults, AFolderThatIsReplacedIsThereAtEveryMoment) {
  write_scene();
  for (const char* name : {"a", "b"}) fs::create_directory(folder / name);
  if (::renameat2(AT_FDCWD, (folder / "a").c_str(), AT_FDCWD, (folder / "b").c_str(),
                  RENAME_EXCHANGE) != 0)
    GTEST_SKIP() << "this disk cannot exchange two names: " << std::strerror(errno);
  ASSERT_EQ(run({"convert", "scene.off", "export/"}).exit_code, 0);
  Watch watch(folder / "export");
  if (!watch.watches()) GTEST_SKIP() << "cannot watch folders: " << std::strerror(errno);
  const ChildResult result = run({"convert", "scene.off", "export/", "--force"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(watch.changes_seen(), "+-i")
      << "the new one appears, then the old one disappears and is emptied";
}

void Faults::expect_survival(int timed) {
  constexpr unsigned seed = 7;
  SCOPED_TRACE("seed " + std::to_string(seed));
  write_hills("old.off", 40, 0);
  // So large that the program checks for Ctrl-C several times.
  write_hills("new.off", 300, 1);
  std::minstd_rand random(seed);
  for (const std::string output : {"out.glb", "export"}) {
    const bool is_folder = output == "export";
    const auto target = [&](const std::string& name) { return is_folder ? name + "/" : name; };
    fs::create_directories(folder / "a");
    fs::create_directories(folder / "b");
    // The file contains its name, so both folders use the same one.
    ASSERT_EQ(run({"convert", "old.off", target("a/" + output)}).exit_code, 0);
    auto whole = std::chrono::microseconds::max();
    for (int i = 0; i < 3; ++i) {
      const Clock::time_point begin = Clock::now();
      ASSERT_EQ(run({"convert", "new.off", target("b/" + output), "--force"}).exit_code, 0);
      whole = std::min(whole,
                       std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - begin));
    }
    const auto before = contents("a/" + output), after = contents("b/" + output);
    ASSERT_NE(before, after);
    for (const int signal : {SIGKILL, SIGINT}) {
      std::vector<Moment> moments = test::moments_of(whole, timed, random);
      // While the new file is written, and between the replacement of the old one and the end.
      moments.push_back({.until = Moment::Until::written, .path = output});
      moments.push_back({.until = Moment::Until::replaced, .path = output});
      int cut_short = 0, replaced = 0;
      for (const Moment& moment : moments) {
        put("a/" + output, output);
        const test::Lookout lookout(moment, folder);
        test::Child child({"convert", "new.off", target(output), "--force"}, folder);
        const bool came = lookout.wait_for(child);
        test::end_by(signal, child);
        const ChildResult result = child.wait();
        const auto now = contents(output);
        EXPECT_TRUE(now == before || now == after)
            << output << " after signal " << signal << " at " << moment.after.count() << " us";
        replaced += now == after;
        // Ctrl-C at this moment may come too late: the old or the new file is correct. SIGKILL
        // leaves the old one.
        if (came && moment.until == Moment::Until::written && signal == SIGKILL) {
          EXPECT_TRUE(now == before);
        }
        if (moment.until == Moment::Until::replaced) {
          EXPECT_TRUE(now == after);
        }
        if (result.exit_code == 0) {
          EXPECT_TRUE(now == after);
          continue;
        }
        ++cut_short;
        if (signal == SIGKILL) {
          test::remove_temporaries(folder);  // a killed program cannot
        } else {
          EXPECT_THAT(names(), Each(Not(HasSubstr(".tmp"))));
          if (result.exit_code != -1) {  // -1: the signal came before the program had made anything
            EXPECT_EQ(result.exit_code, 5) << result.err;
          }
        }
      }
      const int sent = int(moments.size());
      EXPECT_GT(cut_short, 0) << "no moment was early enough";
      EXPECT_LT(replaced, sent) << "the old one never remained";
      EXPECT_GT(replaced, 0) << "no moment was late enough";
      const std::string name = signal == SIGKILL ? "SIGKILL" : "SIGINT";
      test::leave_measured(
          "signals", {{"what", "convert over " + std::string(is_folder ? "a folder" : "a file")},
                      {"signal", name},
                      {"sent", sent},
                      {"cut_short", cut_short},
                      {"old", sent - replaced},
                      {"new", replaced}});
    }
  }
}

TEST_F(Faults, ASignalAtAnyMomentLeavesTheOldOrTheNewWhole) { expect_survival(4); }

/// More moments.
using ThoroughFaults = Faults;
TEST_F(ThoroughFaults, ASignalAtAnyMomentLeavesTheOldOrTheNewWhole) { expect_survival(14); }

}  // namespace faults_program_test
}  // namespace tureen
