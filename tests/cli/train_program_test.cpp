// Program tests of `tureen train`, on photographs of a coloured ball, 32 pixels a side.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

#include "formats/scene_file.hpp"
#include "image/video_file.hpp"
#include "tests/cli/train_fixture.hpp"
#include "tests/support/errors.hpp"
#include "trainer/common/training_log.hpp"

namespace tureen {
namespace train_program_test {

using test::Names;
namespace fs = std::filesystem;
using test::ChildResult;
using test::Train;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

TEST_F(Train, MakesASoupAndAllThatBelongsToIt) {
  make_dataset();
  const ChildResult result =
      train("ball.glb", {"--json", "--preview-every", "20", "--export-diffsoup", "export"}, "40",
            First::as_given);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::vector<std::string> expected{"ball.glb",
                                    "ball.jsonl",
                                    "ball.previews/step_00000020.png",
                                    "ball.previews/step_00000040.png",
                                    "export/lut0.png",
                                    "export/lut1.png",
                                    "export/mesh.ply",
                                    "export/meta.json",
                                    "export/mlp_weights.json"};
  if (have_ffmpeg()) expected.insert(expected.begin(), "ball-previews.mp4");
  EXPECT_EQ(files(), expected);
  EXPECT_THAT(result.err, Names("preset object"));

  ASSERT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1);  // one line
  const auto json = nlohmann::ordered_json::parse(result.out);
  EXPECT_THAT(keys(json), ElementsAre("done", "steps", "seconds", "triangles", "visible_at_start",
                                      "opacity_binary_fraction", "test", "trainer_psnr_db",
                                      "non_finite", "output"));
  EXPECT_EQ(json["done"], true);
  EXPECT_EQ(json["steps"], 40);
  EXPECT_EQ(json["triangles"], 100);
  EXPECT_EQ(json["test"]["views"], 2);
  EXPECT_EQ(json["non_finite"], 0);
  // The bound allows for two renderers and for rounding to bytes.
  EXPECT_NEAR(json["test"]["psnr_db"].get<double>(), json["trainer_psnr_db"].get<double>(), 0.1);

  const Scene scene = read_scene(folder / "ball.glb");
  EXPECT_EQ(scene.info.source, "Tureen trainer, 40 steps");
  EXPECT_EQ(scene.info.name, "ball");
  EXPECT_EQ(scene.info.background, glm::vec3(1));
  EXPECT_EQ(scene.cameras.size(), 8u);
  const auto& soup = only_soup(scene);
  EXPECT_EQ(soup.triangles.size(), 100u);
  EXPECT_FALSE(std::get<LatticeTexture>(soup.appearance).is_float());
  EXPECT_EQ(read_png("ball.previews/step_00000040.png").width, 3 * size);
  const ChildResult evaluated = run({"eval", "ball.glb", "ball", "--json"});
  if (evaluated.exit_code == 0) {
    EXPECT_EQ(nlohmann::ordered_json::parse(evaluated.out)["mean"]["psnr_db"],
              json["test"]["psnr_db"]);
  } else {
    EXPECT_EQ(evaluated.exit_code, 4) << evaluated.err;
    EXPECT_EQ(json["test"]["drawn_by"], "trainer");
  }
}

TEST_F(Train, MeasuresItsOwnDrawingWhereTheDeviceCannotDrawTheTestViews) {
  write_split("train", 8, 0, Behind::transparent);
  // The widest image that the trainer accepts. llvmpipe and most devices draw at most 16,384 pixels
  // a side.
  constexpr int width = 32767, height = 11;
  const Camera wide = look_at({4, 0, 0}, {0, 0, 0}, {0, 0, 1}, 0.7, width, height);
  fs::create_directories(folder / "ball/test");
  write_png("ball/test/wide.png", Image8(width, height, glm::u8vec4(255)));
  nlohmann::json document = test::transforms_of(wide);
  document["frames"].push_back(test::frame_of("test/wide.png", wide));
  write("ball/transforms_test.json", document.dump());

  const ChildResult result = train("ball.glb", {"--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::ordered_json::parse(result.out);
  if (json["test"]["drawn_by"] != "trainer")
    GTEST_SKIP() << "this device draws 32,767 pixels a side";
  EXPECT_EQ(json["test"]["psnr_db"], json["trainer_psnr_db"]);
  EXPECT_GT(json["trainer_psnr_db"], 0);
  EXPECT_TRUE(exists("ball.glb"));
  // Without OpenGL, that is the reason instead.
  if (run({"render", "ball.glb", "-o", "ball.png"}).exit_code == 0) {
    EXPECT_THAT(result.err, Names("32767x11"));
  }
}

TEST_F(Train, EqualSeedsGiveEqualSoupsOnAnyNumberOfThreads) {
  make_dataset();
  ASSERT_EQ(train("a.glb", {}, "12", First::as_given).exit_code, 0);
  fs::create_directories(folder / "b");
  // The file contains its name, so both folders use the same one.
  ASSERT_EQ(train("b/a.glb", {"--threads", "1"}).exit_code, 2);  // --threads is given twice
  std::vector<std::string> one = arguments("b/a.glb", {}, "12", First::as_given);
  *std::find(one.begin(), one.end(), "2") = "1";
  ASSERT_EQ(run(one).exit_code, 0);
  EXPECT_EQ(bytes("a.glb"), bytes("b/a.glb"));
  ASSERT_EQ(train("b/a.glb", {"--seed", "1"}, "12", First::as_given).exit_code, 0);
  EXPECT_NE(bytes("a.glb"), bytes("b/a.glb"));
}

TEST_F(Train, GoesOnAfterCtrlCAsIfItHadNotHappened) {
  make_dataset();
  const auto [cut, count] =
      interrupted(300, [](const std::string& number) { return arguments("ball.glb", {}, number); });
  ASSERT_EQ(cut.exit_code, 5) << cut.err;
  EXPECT_THAT(cut.err, Names("ball.checkpoint", "--resume"));
  EXPECT_THAT(files(), ElementsAre("ball.checkpoint", "ball.jsonl"));

  // The program does not silently restart, or continue with other constants or photographs.
  const std::string steps = std::to_string(count);
  const auto refused = [&](const std::vector<std::string>& more, const auto&... values) {
    const ChildResult result = train("ball.glb", more, steps);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, Names(values...));
  };
  refused({}, "ball.checkpoint");
  refused({"--resume", "--seed", "3"}, "seed", 3, 0);
  refused({"--resume", "--scale", "0.5"}, "r_0.png", 16, 32);
  EXPECT_THAT(train("ball.glb", {"--resume"}, std::to_string(count + 1)).err,
              Names("steps", count + 1, count));

  // Without options, the constants are those of the checkpoint.
  const ChildResult result =
      run({"train", "ball", "-o", "ball.glb", "--resume", "--device", "cpu"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(exists("ball.checkpoint"));
  fs::create_directories(folder / "whole");
  ASSERT_EQ(train("whole/ball.glb", {}, steps).exit_code, 0);
  EXPECT_EQ(bytes("ball.glb"), bytes("whole/ball.glb"));
  // There is one log, and each step is in it once.
  const std::string log = bytes("ball.jsonl"), whole = bytes("whole/ball.jsonl");
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), std::count(whole.begin(), whole.end(), '\n'));
}

/// Writes a command for the run.
void tell(const fs::path& control, std::string_view word) { write_file(control, word); }

/// How often programs have read a file since the construction.
class Readings {
 public:
  explicit Readings(const fs::path& file)
      : name_(file.filename().string()), events_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    // Watches the folder, because each command is a new file.
    EXPECT_GE(::inotify_add_watch(events_, file.parent_path().c_str(), IN_CLOSE_NOWRITE), 0);
  }
  Readings(const Readings&) = delete;
  Readings& operator=(const Readings&) = delete;
  ~Readings() { ::close(events_); }

  int count() {
    alignas(inotify_event) char bytes[4096];
    for (ssize_t size; (size = ::read(events_, bytes, sizeof bytes)) > 0;)
      for (ssize_t at = 0; at < size;) {
        const auto* event = reinterpret_cast<const inotify_event*>(bytes + at);
        at += ssize_t(sizeof(inotify_event) + event->len);
        count_ += event->len > 0 && event->name == name_;
      }
    return count_;
  }

 private:
  std::string name_;
  int events_, count_ = 0;
};

TEST_F(Train, AWatchedAndPausedRunMakesTheSameSoup) {
  ::unsetenv("DISPLAY");  // the window cannot open; the training goes on
  make_dataset();
  const std::string steps = "1500";  // far more than the run takes until it reads the command
  test::Child child(arguments("ball.glb", {"--watch"}, steps), folder);
  ASSERT_TRUE(child.wait_until([&] { return has_begun(); }));
  child.stop();
  EXPECT_TRUE(exists("ball.watch.glb"));
  tell(folder / "ball.control", "pause\n");
  Readings readings(folder / "ball.control");
  child.signal(SIGCONT);
  // The first reading may have begun before the command. After the second one, the run ends its
  // step and may write a record; at the third one, it is paused.
  ASSERT_TRUE(child.wait_until([&] { return readings.count() >= 3; }));
  const std::string log = bytes("ball.jsonl");
  // A run that is not paused writes about ten records meanwhile.
  ASSERT_TRUE(child.wait_until([&] { return readings.count() >= 8; }));
  EXPECT_EQ(bytes("ball.jsonl"), log);
  EXPECT_TRUE(child.running());
  tell(folder / "ball.control", "run\n");
  const ChildResult result = child.wait();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(files(), ElementsAre("ball.glb", "ball.jsonl", "ball.watch.glb"));
  fs::create_directories(folder / "whole");
  ASSERT_EQ(train("whole/ball.glb", {}, steps).exit_code, 0);
  EXPECT_EQ(bytes("ball.glb"), bytes("whole/ball.glb"));
  EXPECT_EQ(bytes("ball.watch.glb"), bytes("ball.glb"));  // the finished scene at last
}

TEST_F(Train, StopsAndKeepsWhatIsTrained) {
  make_dataset();
  test::Child child(arguments("ball.glb", {"--json", "--preview-every", "90000"}, "100000"),
                    folder);
  ASSERT_TRUE(child.wait_until([&] { return has_begun(); }));
  tell(folder / "ball.control", "finish\n");
  const ChildResult result = child.wait();
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::ordered_json::parse(result.out);
  const int step = json["steps"];
  EXPECT_LT(step, 100'000);
  EXPECT_EQ(json["test"]["views"], 2);
  const auto log = trainer::read_training_log(folder / "ball.jsonl");
  EXPECT_EQ(log.back().step, step);
  EXPECT_EQ(log.back().steps, 100'000);
  EXPECT_TRUE(log.back().ended_early);
  EXPECT_TRUE(log.back().test_psnr_db);
  EXPECT_FALSE(log.front().ended_early);
  EXPECT_EQ(read_scene(folder / "ball.glb").info.source,
            "Tureen trainer, " + std::to_string(step) + " steps");
  EXPECT_EQ(files().size(), 3u);  // with the last preview
}

TEST_F(Train, TakesNoOtherFileForItsControlFile) {
  make_dataset();
  write("ball.control", "Dear diary");
  const ChildResult refused = train("ball.glb");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, Names("ball.control"));
  EXPECT_THAT(files(), ElementsAre("ball.control"));
  EXPECT_EQ(bytes("ball.control"), "Dear diary");
  EXPECT_EQ(train("ball.glb", {"--log", "ball.control"}).exit_code, 2);
  // That of a killed run ends no other.
  write("ball.control", "finish\n");
  ASSERT_EQ(train("ball.glb").exit_code, 0);
  EXPECT_EQ(trainer::read_training_log(folder / "ball.jsonl").back().step, 40);
  EXPECT_FALSE(exists("ball.control"));
}

TEST_F(Train, SaysThatCtrlCBeforeTheFirstStepLeavesNoCheckpoint) {
  make_dataset();
  // The same photograph 30,000 times, so that reading takes a while.
  auto document = nlohmann::json::parse(bytes("ball/transforms_train.json"));
  const nlohmann::json frame = document["frames"][0];
  for (int i = 0; i < 30'000; ++i) document["frames"].push_back(frame);
  write("ball/transforms_train.json", document.dump());
  test::Child child(arguments("a.glb"), folder);
  ASSERT_TRUE(child.wait_until([&] { return exists("a.lock"); }));
  child.signal(SIGINT);
  const ChildResult result = child.wait();
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_THAT(result.err, Not(Names("--resume")));
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(Train, RefusesACheckpointThatIsAFolder) {
  make_dataset();
  fs::create_directory(folder / "a.checkpoint");
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{}, {"--resume"}}) {
    const ChildResult result = train("a.glb", more);
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_THAT(result.err, StartsWith("tureen: a.checkpoint: "));
  }
}

TEST_F(Train, CheckpointsAsOftenAsItIsTold) {
  make_dataset();
  // The program starts a new log, so it must not replace another file.
  for (const char* log : {"ball/transforms_train.json", "ball.glb"}) {
    const std::string before = bytes(log);
    const ChildResult result = train("ball.glb", {"--log", log});
    EXPECT_EQ(result.exit_code, 2) << log;
    EXPECT_EQ(bytes(log), before) << log;
  }
  EXPECT_THAT(files(), IsEmpty());

  // The program finds a folder in the checkpoint's place before the training.
  fs::create_directories(folder / "ball.checkpoint");
  const ChildResult refused = train("ball.glb");
  EXPECT_EQ(refused.exit_code, 5);
  EXPECT_THAT(refused.err, Names("ball.checkpoint"));
  EXPECT_THAT(files(), IsEmpty());
  fs::remove(folder / "ball.checkpoint");

  test::Child child(arguments("ball.glb", {"--checkpoint-every", "10"}, "100000"), folder);
  ASSERT_TRUE(child.wait_until([&] { return exists("ball.checkpoint"); }));
  child.signal(SIGKILL);  // it cannot write anything more
  EXPECT_EQ(child.wait().exit_code, -1);
  EXPECT_TRUE(exists("ball.checkpoint"));
  const ChildResult cut = train("ball.glb", {"--resume"});
  EXPECT_EQ(cut.exit_code, 2);  // the checkpoint is readable
  EXPECT_THAT(cut.err, Names("steps", 40, 100000));
  write("ball.checkpoint", bytes("ball.checkpoint").substr(0, 5000));
  const ChildResult damaged = train("ball.glb", {"--resume"});
  EXPECT_EQ(damaged.exit_code, 3);
  EXPECT_THAT(damaged.err, Names("ball.checkpoint"));
}

TEST_F(Train, TakesItsConstantsFromPresetFileAndOptions) {
  make_dataset(Behind::place);
  write("few.json", R"({"steps": 30, "triangles": 60, "initial_triangles": 120, "seed": 5})");
  const auto print = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"train", "ball", "--print-config"};
    all.insert(all.end(), more.begin(), more.end());
    const ChildResult result = run(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  EXPECT_EQ(print({})["preset"], "scene");  // no alpha
  make_dataset(Behind::white);
  EXPECT_EQ(print({})["preset"], "object");
  EXPECT_EQ(print({})["background"], nlohmann::json({1, 1, 1}));
  make_dataset(Behind::place);
  EXPECT_EQ(print({"--preset", "object"})["preset"], "object");
  EXPECT_EQ(print({"--compat"})["max_level"], 5);
  EXPECT_EQ(print({"--init", "random"})["initialisation"], "random");
  const auto mixed = print({"--config", "few.json", "--triangles", "30", "--level", "1"});
  EXPECT_EQ(mixed["steps"], 30);
  EXPECT_EQ(mixed["seed"], 5);
  EXPECT_EQ(mixed["triangles"], 30);
  EXPECT_EQ(mixed["initial_triangles"], 60);  // the same proportion as before
  EXPECT_EQ(mixed["max_level"], 1);
  EXPECT_EQ(mixed["min_level"], 1);
  EXPECT_THAT(files(), ElementsAre("few.json"));

  // It also trains with them, from the triangles of a scene.
  write_scene();
  const ChildResult result = run(
      {"train", "ball", "-o", "ball.glb", "--config", "few.json", "--init", "scene.off", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["triangles"], 60);
}

TEST_F(Train, ExitCodesSayWhoIsToBlame) {
  make_dataset();
  const auto expect = [&](const std::vector<std::string>& words, int code, const auto&... values) {
    const ChildResult result = run(words);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, Names(values...));
    EXPECT_THAT(result.out, IsEmpty());
  };
  const auto given = [](const std::string& output, const std::vector<std::string>& more,
                        const std::string& steps = "40") {
    return arguments(output, more, steps, First::as_given);
  };
  expect({"train"}, 2, "DATASET");
  expect({"train", "ball"}, 2, "-o", "OUT.glb");
  expect({"train", "ball", "-o", "ball.jpg"}, 2, "ball.jpg", ".glb");
  expect(given("b.glb", {"--preset", "scenery"}), 2, "scenery", "scene");
  expect(given("b.glb", {"--level", "9"}), 2, "max_level", 9);
  expect(given("b.glb", {"--batch", "0"}), 2, "batch", 0);
  expect(given("b.glb", {"--init", "points"}), 3);
  expect(given("b.glb", {"--batch", "5000"}), 2, "batch", 5000, 1024);
  expect(given("b.glb", {}, "99999999999"), 2, "steps", "99999999999", 10000000);
  expect(given("b.glb", {"--init", "none.off"}), 3, "none.off");
  expect(given("b.glb", {"--init", "pionts"}), 3, "pionts", "points");
  expect(given("b.glb", {"--config", "none.json"}), 3, "none.json");
  write("bad.json", R"({"stepz": 3, "sed": 1})");
  expect(given("b.glb", {"--config", "bad.json"}), 3, "bad.json", "stepz", "steps");
  expect(given("b.glb", {"--config", "bad.json"}), 3, "sed", "seed");
  write("mesh.json", R"({"initialisation": "mesh"})");
  expect(given("b.glb", {"--config", "mesh.json"}), 2, "--init", "FILE");
  write("scene.json", R"({"preset": "scene"})");
  expect(given("b.glb", {"--config", "scene.json", "--preset", "object"}), 2, "--preset",
         "scene.json");
  expect(given("b.glb", {"--resume"}), 3, "b.checkpoint");
  expect(given("b.glb", {"--scale", "0.2"}), 3, "6 x 6", 11);
  expect(arguments("none/b.glb"), 5, "none/b.glb");
  expect(given("b.glb", {"--export-diffsoup", "ball"}), 2, "ball");
  expect(given("b.glb", {"--export-diffsoup", "b.glb/"}), 2, "b.glb");
  expect(given("b.glb", {"--log", "b.lock"}), 2, "b.lock");
  expect(given("b.glb", {"--seed", "-1"}), 2, "--seed", -1);
  expect(given("b.glb", {"--seed", "99999999999999999999"}), 2, "--seed");
  fs::remove(folder / "ball/train/r_3.png");
  expect(given("b.glb", {"--strict"}), 3, "r_3", "--strict");
  expect({"train", "bal", "-o", "b.glb"}, 3, "bal", "ball");
  EXPECT_THAT(files(), ElementsAre("bad.json", "mesh.json", "scene.json"));
}

TEST_F(Train, TwoRunsDoNotShareAnOutput) {
  make_dataset();
  test::Child first(arguments("ball.glb", {}, "100000"), folder);
  ASSERT_TRUE(first.wait_until([&] { return exists("ball.jsonl"); }));
  const ChildResult second = train("ball.glb");
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.err, Names("ball.lock"));
  first.signal(SIGKILL);
  first.wait();
  EXPECT_TRUE(exists("ball.lock"));  // but no process holds it
  fs::remove(folder / "ball.checkpoint");
  const ChildResult third = train("ball.glb");
  EXPECT_EQ(third.exit_code, 0) << third.err;
  EXPECT_THAT(files(), ElementsAre("ball.glb", "ball.jsonl"));
}

TEST_F(Train, KeepsWhatItHasLearnedWhereAFileCannotBeWritten) {
  make_dataset();
  fs::create_directories(folder / "ball.previews/step_00000020.png/in the way");
  const std::vector<std::string> previews{"--preview-every", "10"};
  const ChildResult failed = train("ball.glb", previews);
  EXPECT_EQ(failed.exit_code, 5);
  EXPECT_THAT(failed.err, Names("ball.checkpoint", "20 of 40", "ball.previews/step_00000020.png"));
  EXPECT_FALSE(exists("ball.glb"));

  const ChildResult went_on = train("ball.glb", {"--resume"});
  EXPECT_EQ(went_on.exit_code, 0) << went_on.err;
  EXPECT_FALSE(exists("ball.checkpoint"));
  ASSERT_EQ(train("whole.glb").exit_code, 0);
  const auto soup_of = [&](const std::string& name) {
    EXPECT_EQ(run({"convert", name + ".glb", name + ".ply"}).exit_code, 0);
    return bytes(name + ".ply");
  };
  EXPECT_EQ(soup_of("ball"), soup_of("whole"));
}

TEST_F(Train, GoesOnWhereNohupLetsItIgnoreTheHangup) {
  make_dataset();
  const auto before = ::signal(SIGHUP, SIG_IGN);  // a child inherits it
  test::Child child(arguments("ball.glb", {}, "60"), folder);
  ::signal(SIGHUP, before);
  ASSERT_TRUE(child.wait_until([&] { return exists("ball.jsonl"); }));
  child.signal(SIGHUP);
  EXPECT_EQ(child.wait().exit_code, 0);
  EXPECT_TRUE(exists("ball.glb"));
}

TEST_F(Train, ExportsAFolderWhateverItsName) {
  make_dataset();
  ASSERT_EQ(train("ball.glb", {"--export-diffsoup", "web_0.5/"}, "2").exit_code, 0);
  EXPECT_TRUE(exists("web_0.5/mesh.ply"));
  EXPECT_TRUE(exists("web_0.5/meta.json"));
}

TEST_F(Train, SaysThatNoImageShowsATriangle) {
  make_dataset();
  write("far.off", "OFF\n3 1 0\n1000 1000 1000\n1001 1000 1000\n1000 1001 1000\n3 0 1 2\n");
  const auto visible = [&](std::vector<std::string> more) {
    more.push_back("--json");
    const ChildResult result = train("ball.glb", more, "2", First::as_given);
    return nlohmann::json::parse(result.out)["visible_at_start"];
  };
  EXPECT_EQ(visible({"--init", "far.off"}), false);
  EXPECT_EQ(visible({}), true);
}

TEST_F(Train, DoesNotReplaceWhatItBeginsWith) {
  make_dataset();
  ASSERT_EQ(train("ball.glb", {}, "2").exit_code, 0);
  const std::string before = bytes("ball.glb");
  const ChildResult refused = train("ball.glb", {"--init", "ball.glb"}, "40", First::as_given);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, Names("-o", "ball.glb", "--init"));
  EXPECT_EQ(bytes("ball.glb"), before);
  EXPECT_THAT(train("ball.glb", {}, "2").err, Names("ball.glb"));
}

}  // namespace train_program_test
}  // namespace tureen
