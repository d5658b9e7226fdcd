// What the pages of docs/ say of what was measured.
#include "bench/page/sections.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <span>

#include "bench/growth_report.hpp"
#include "cli/bench_result.hpp"
#include "cli/tradeoff_fixture.hpp"
#include "cli/tradeoff_reading.hpp"
#include "cli/tradeoff_scenes_report.hpp"
#include "formats/format_testing.hpp"
#include "soup/error.hpp"
#include "support/measured.hpp"

namespace tureen::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using tureen::testing::TemporaryFolder;

/// A folder as reproduce.sh leaves it.
class BenchPage : public ::testing::Test {
 protected:
  void write(const std::string& path, const std::string& text) const {
    fs::create_directories((folder() / path).parent_path());
    std::ofstream(folder() / path) << text;
  }
  void measure(const std::string& name, const std::string& printed) {
    names_.push_back(name);
    const Json run{{"command", "tureen " + name},
                   {"date", "2026-01-02T03:04:05Z"},
                   {"commit", "abc1234"},
                   {"cpu", "Some | CPU"},
                   {"cores", 2}};
    write(name + ".run.json", run.dump());
    write(name + ".txt", printed);
  }
  Measurements measurements() const { return {folder(), names_}; }
  Section section(const std::string& name) const {
    for (const Section& each : sections_of(measurements()).made)
      if (each.name == name) return each;
    ADD_FAILURE() << "there is no section " << name;
    return {};
  }
  fs::path folder() const { return folder_ / "measured"; }

 private:
  TemporaryFolder folder_;
  std::vector<std::string> names_;
};

cli::BenchMeasurement timed(const char* configuration, const char* size, double ms) {
  cli::BenchMeasurement result;
  result.configuration = configuration;
  result.camera_set = "hemisphere:8";
  result.size = size;
  result.frame_ms = {.mean = ms,
                     .median = ms + 1,
                     .p95 = ms + 2,
                     .p99 = ms + 3,
                     .min_of_medians = ms,
                     .spread = 0,
                     .low_1_percent_fps = 1000 / (ms + 4),
                     .rounds = 15,
                     .samples = 120};
  result.views = 8;
  result.frames = 240;
  result.aa_spread = 0.02;
  return result;
}

TEST_F(BenchPage, TimesStandBesideThoseOfTheFirstConfiguration) {
  cli::BenchResult bench;
  bench.scene.triangles = 7000;
  bench.device.renderer = "llvmpipe";
  bench.device.software = true;
  bench.protocol.clock = "steady";
  bench.configurations = {
      {"tureen", {}, {}, 0, 0, 0}, {"generic", {}, {}, 0, 0, 0}, {"published", {}, {}, 0, 0, 0}};
  bench.measurements = {timed("tureen", "640x360", 10), timed("generic", "640x360", 10.3),
                        timed("published", "640x360", 52), timed("tureen", "full", 4),
                        timed("published", "full", 2)};
  measure("frames-lego", "a table for a terminal");
  write("frames-lego/bench.json", cli::to_json(bench).dump());
  write("frames-lego/pixels-hemisphere-8.svg", "<svg/>");
  const Section told = section("frames-lego");
  EXPECT_THAT(told.text,
              AllOf(HasSubstr("Measured 2026-01-02 at abc1234, 2 cores of Some | CPU:"),
                    HasSubstr("```\ntureen frames-lego\n```"), HasSubstr("llvmpipe, software")));
  EXPECT_THAT(
      told.text,
      HasSubstr("| hemisphere:8 | 640x360 | 15 | 240 | 2.0 % | 0.0 % | 10.0 | 11.0 | 12.0 | 13.0 | "
                "71.4 | 10.3 (equal) | 52.0 (5.20) |\n"));
  EXPECT_THAT(told.text, HasSubstr("| – | 2.00 (0.50) |\n")) << "generic was not timed there";
  EXPECT_THAT(told.text, HasSubstr("](images/bench-frames-lego-pixels-hemisphere-8.svg)"));
  ASSERT_EQ(told.plots.size(), 1u) << "no ratios were drawn";
  EXPECT_TRUE(fs::exists(told.plots[0].from));
}

TEST_F(BenchPage, WhatTimesDoNotTellIsMarked) {
  cli::BenchResult bench;
  bench.program.build = "release";
  bench.machine.rasteriser_threads = 3;
  bench.configurations = {{"tureen", {}, {}, 0, 0, 0}, {"generic", {}, {}, 0, 0, 0}};
  bench.measurements = {timed("tureen", "640x360", 10), timed("generic", "640x360", 52),
                        timed("tureen", "full", 10), timed("generic", "full", 52)};
  bench.measurements[1].frame_ms.spread = 2.2;  // 52 is 4.2 times as much more than 10
  measure("frames-lego", "");
  const auto text = [&] {
    write("frames-lego/bench.json", cli::to_json(bench).dump());
    return section("frames-lego").text;
  };
  EXPECT_THAT(text(),
              AllOf(HasSubstr(" | 52.0 (equal) |"), HasSubstr(" | 52.0 (5.20) |"),
                    HasSubstr("rasteriser threads: 3; release build; "), Not(HasSubstr("†"))));
  for (cli::BenchMeasurement& m : bench.measurements) m.frame_ms.rounds = 2;  // 16 samples
  bench.measurements[3].stable = false;
  EXPECT_THAT(text(), AllOf(HasSubstr("| 2 | 240 | 2.0 % | – | 10.0 | 11.0 | 12.0 | – | – | "
                                      "52.0 (2 rounds) |"),
                            HasSubstr(" | 52.0† (2 rounds) |\n\n† Its warm-up had not")));
}

TEST_F(BenchPage, StagesOfAllScenesStandInOneTable) {
  for (const char* scene : {"stages-example", "stages-fox"}) {
    cli::BenchResult bench;
    bench.configurations = {{"tureen-fragment", {}, {}, 0, 0, 0},
                            {"tureen-compute", {}, {}, 0, 0, 0}};
    bench.measurements = {timed("tureen-fragment", "1280x720", 10),
                          timed("tureen-compute", "1280x720", 25)};
    measure(scene, "");
    write(std::string(scene) + "/bench.json", cli::to_json(bench).dump());
  }
  const std::string text = section("stages").text;
  EXPECT_THAT(text, HasSubstr("```\ntureen stages-example\ntureen stages-fox\n```"));
  EXPECT_THAT(
      text,
      HasSubstr(
          "| fox | hemisphere:8 | 1280x720 | 15 | 240 | 2.0 % | 0.0 % | 10.0 | 25.0 (2.50) |"));
}

TEST_F(BenchPage, AGpuIsHeldAgainstItsCeilings) {
  cli::BenchResult bench;
  bench.scene.triangles = 15000;
  bench.device.renderer = "a GPU";
  bench.configurations = {{"tureen", {}, {}, 0, 0, 0}, {"published", {}, {}, 0, 0, 0}};
  bench.measurements = {timed("tureen", "1280x720", 0.5), timed("published", "1280x720", 2),
                        timed("triangles", "1280x720", 0.1), timed("copy", "1280x720", 0.4),
                        timed("tureen", "640x360", 0.5)};
  bench.measurements[0].fps = 1996;
  measure("gpu-cloud", "");
  write("gpu-cloud/bench.json", cli::to_json(bench).dump());
  const std::string text = section("gpu").text;
  EXPECT_THAT(text, HasSubstr("| cloud | 15000 | hemisphere:8 | 1280x720 | 240 | 2.0 % | 0.0 % | "
                              "0.500 | 1996 | 80.0 % | 2.00 (4.00) | 0.100 (0.20) | "
                              "0.400 (0.80) | – | – |"));
  EXPECT_THAT(text, HasSubstr("| 640x360 | 240 | 2.0 % | 0.0 % | 0.500 | 0 | – | – |"));
}

TEST_F(BenchPage, AStudyTellsTheChoiceAndEveryKnobAlone) {
  nlohmann::json study = lego();
  auto& drawing = study["drawing"]["configurations"];
  nlohmann::json both = drawing[2];  // lattice level 2
  ASSERT_EQ(both["name"], "lattice level 2");
  for (auto& [key, setting] : both["knobs"].items())
    for (const auto& knob : study["drawing"]["knobs"])
      if (knob["key"] == key) setting = knob["settings"].back();
  ASSERT_GE(both["knobs"].size(), 2u);
  both["name"] = "a combination";
  both["on_front"] = false;
  drawing.push_back(both);
  study["e_model"] = {
      {"dataset", "lego"}, {"split", "test"}, {"photographs", 25}, {"ssim_border", "valid"}};
  drawing[0]["e_model"] = {{"psnr_db", 29.5}, {"ssim", 0.96}, {"flip", nullptr}};
  ASSERT_EQ(drawing[5]["method"], "oracle");
  drawing[5]["e_model"] = {{"psnr_db", 29.25}, {"ssim", 0.95}, {"flip", nullptr}};
  drawing[0]["warnings"] = {"its times were restless"};
  measure("tradeoff-lego", "");
  write("tradeoff-lego/tradeoff.json", study.dump());
  const std::string text = section("tradeoff-lego").text;
  EXPECT_THAT(text, HasSubstr("\n† defaults: its times were restless.\n"));
  EXPECT_THAT(text, HasSubstr("The choice, the cheapest with at least"));
  for (const char* panel : {"drawing", "antialiasing"}) {
    SCOPED_TRACE(panel);
    EXPECT_THAT(text, HasSubstr(fmt::format("{} configurations were measured",
                                            study[panel]["configurations"].size())));
    for (const auto& each : study[panel]["configurations"])
      if (each["method"] == "tureen" && each["name"] != "a combination") {
        EXPECT_THAT(text, HasSubstr("| " + each["name"].get<std::string>() + " | "));
      }
  }
  EXPECT_THAT(text, Not(HasSubstr("a combination"))) << "it is not on the front";
  EXPECT_THAT(text, HasSubstr("(emulated) | – | – | – |")) << "it has no time";
  EXPECT_THAT(text, HasSubstr("E_model, against 25 photographs (test):"));
  EXPECT_THAT(text, HasSubstr("| defaults | 29.50 | 0.9600 |\n"));
  EXPECT_THAT(text, HasSubstr("| MLP in half floats (emulated) | 29.25 | 0.9500 |\n"));
  std::size_t defaults = 0;
  for (std::size_t at = 0; (at = text.find("\n| defaults |", at)) != std::string::npos; ++at)
    ++defaults;
  EXPECT_EQ(defaults, 3u) << "of each panel's, and what photographs say; none of generic plans";

  study["choice"] = nullptr;
  write("tradeoff-lego/tradeoff.json", study.dump());
  EXPECT_THAT(section("tradeoff-lego").text, HasSubstr("none keeps to the limits"));
}

TEST_F(BenchPage, JoinedScenesTellMeansAndWhereTheyAreWorst) {
  std::vector<cli::TradeoffRun> runs;
  for (const nlohmann::json& document : {lego(), chair()}) {
    const std::string text = document.dump();
    Input input = Input::memory("tradeoff.json", std::as_bytes(std::span(text)));
    runs.push_back({"tradeoff.json", cli::read_tradeoff(input)});
  }
  const cli::TradeoffScenes scenes = cli::join(std::move(runs));
  measure("tradeoff-scenes", "");
  write("tradeoff-scenes/scenes.json", cli::to_json(scenes).dump());
  const std::string text = section("tradeoff-scenes").text;
  EXPECT_THAT(text, HasSubstr("2 scenes"));
  EXPECT_THAT(text, HasSubstr("| defaults | 1.000 | "));
  EXPECT_THAT(text, HasSubstr(", chair | ")) << "which comes 10 dB less near";
  EXPECT_THAT(text, Not(HasSubstr(", lego | ")));
}

TEST_F(BenchPage, GrowthTellsTimesAndFits) {
  Growth growth{.commit = "abc1234",
                .cpu = "a CPU",
                .context = "EGL",
                .renderer = "llvmpipe",
                .software = true};
  for (const char* kind : {"opaque", "cut-out"})
    for (const char* series : {"triangles", "pixels", "overdraw"})
      for (int i = 1; i <= 8; ++i) {
        const std::string grows = series;
        GrowthPoint point{.kind = kind,
                          .series = series,
                          .layers = grows == "overdraw" ? i : 4,
                          .width = grows == "pixels" ? 160 * i : 1280,
                          .height = grows == "pixels" ? 90 * i : 720};
        point.sample.triangles = grows == "triangles" ? 1000 << i : 65536;
        point.sample.shaded_pixels = 0.64 * point.width * point.height;
        point.sample.fragments = point.sample.shaded_pixels * point.layers;
        point.sample.ms = 0.5 + 2e-5 * point.sample.triangles + 3e-6 * point.sample.fragments +
                          4e-5 * point.sample.shaded_pixels;
        growth.points.push_back(point);
      }
  fit(growth);
  measure("growth", "opaque: a frame costs 0.5 ms\nopaque: the model is off by 0 %\n");
  fs::create_directories(folder() / "growth");
  write_growth(growth, folder() / "growth");
  const std::string text = section("growth").text;
  EXPECT_THAT(text, HasSubstr("| triangles | 2000 | 4000 | 8000 |"));
  EXPECT_THAT(text, HasSubstr("| size | 160x90 | 320x180 |"));
  EXPECT_THAT(text, HasSubstr("| layers | 1 | 2 | 3 |"));
  EXPECT_THAT(text, HasSubstr("| opaque | 0.5 ± "));
  EXPECT_THAT(text, HasSubstr("- opaque: the model is off by 0 %\n"));
}

TEST_F(BenchPage, SlimFilesAndTrainingsAreRowsOfWhatTheyPrint) {
  const Json slim{{"scene_bytes", 1000},     {"loss_db", 0.0987},    {"loss_is_measured", true},
                  {"render_psnr_db", 40.25}, {"faces_left_out", 12}, {"published_bytes", 4200},
                  {"times_smaller", 4.2}};
  measure("slim-lego", slim.dump());
  Json estimated = slim;
  estimated["loss_is_measured"] = false;
  estimated.erase("published_bytes");
  estimated.erase("times_smaller");
  measure("slim-uv", estimated.dump());
  EXPECT_THAT(section("slim").text,
              AllOf(HasSubstr("| lego | 4200 | 1000 | 4.20 | 0.099, measured | 40.25 | 12 |\n"),
                    HasSubstr("| uv | – | 1000 | – | 0.099, estimated | 40.25 | 12 |\n")));

  const Json run{{"steps", 100},
                 {"seconds", 12.4},
                 {"triangles", 50},
                 {"test", {{"views", 3}, {"psnr_db", 21.5}, {"ssim", 0.9}, {"flip", 0.1}}},
                 {"trainer_psnr_db", 21.49},
                 {"opacity_binary_fraction", 0.875},
                 {"non_finite", 0}};
  measure("train-lego", run.dump());
  measure("train-fox", run.dump());
  write("train-lego/log.svg", "<svg/>");
  write("train-fox/log.svg", "<svg/>");
  measure("ablation-ours", run.dump());
  write("ablation-ours/log.svg", "<svg/>");
  EXPECT_THAT(
      section("train").text,
      HasSubstr("| lego | 100 | 50 | 3 | 21.50 | 0.9000 | 0.1000 | 21.49 | 87.5 % | 0 | 12 |\n"));
  // Each run's plot is its own.
  EXPECT_THAT(section("train").text, AllOf(HasSubstr("](images/bench-train-fox-log.svg)"),
                                           HasSubstr("](images/bench-train-lego-log.svg)")));
  // Runs of which the last numbers are compared have none.
  EXPECT_THAT(section("ablation").text, AllOf(HasSubstr("| ours | 100 |"), Not(HasSubstr("svg"))));
}

TEST_F(BenchPage, TablesThatProgramsPrintStayAsTheyAre) {
  measure("load", "| format |\n|---|\n| GLB |\n");
  measure("browser-devices", "for a terminal");
  write("browser-devices/table.md", "| device |\n|---|\n");
  for (const char* name : {"agreement-random", "agreement-real"}) {
    measure(name, "[  PASSED  ]");
    write(std::string(name) + "/table.md", std::string("| ") + name + " |\n|---|\n");
  }
  EXPECT_THAT(section("load").text, HasSubstr("| format |\n|---|\n| GLB |\n"));
  EXPECT_THAT(section("browser-devices").text,
              AllOf(HasSubstr("| device |"), Not(HasSubstr("for a terminal"))));
  EXPECT_THAT(section("agreement").text,
              AllOf(HasSubstr("| agreement-random |"), HasSubstr("| agreement-real |"),
                    Not(HasSubstr("PASSED"))));
}

TEST_F(BenchPage, ResultsOfOtherRunsStayOut) {
  measure("load", "| now |\n");
  write("growth.run.json", "{}");  // an earlier run's
  ASSERT_EQ(sections_of(measurements()).made.size(), 1u);
}

TEST_F(BenchPage, SaysWhoseResultLacksSomethingAndMakesTheOthers) {
  measure("slim-lego", R"({"scene_bytes": null})");
  measure("load", "| now |\n");
  measure("step", "");
  write("step.run.json", "{");
  const Sections sections = sections_of(measurements());
  ASSERT_EQ(sections.made.size(), 1u);
  EXPECT_EQ(sections.made[0].name, "load");
  EXPECT_THAT(sections.failures, ElementsAre(StartsWith("slim: "), StartsWith("step: ")));
}

TEST_F(BenchPage, SaysWhatNoRunLeft) {
  const Sections sections = sections_of({folder(), {"load"}});
  EXPECT_THAT(sections.made, IsEmpty());
  EXPECT_THAT(sections.failures, ElementsAre(StartsWith("load: ")));
}

TEST_F(BenchPage, IsWrittenBetweenItsMarksAlone) {
  const Marks load("./dev bench, load"), growth("./dev bench, growth");
  const auto page = [&](const std::string& end) {
    return "before\n" + load.begin + "old\n" + end + "between\n" + growth.begin + "as it is\n" +
           growth.end + "after\n";
  };
  write("page.md", page(load.end));
  write_between(folder() / "page.md", load, "new\n");
  std::ifstream file(folder() / "page.md");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}),
            "before\n" + load.begin + "new\n" + load.end + "between\n" + growth.begin +
                "as it is\n" + growth.end + "after\n");
  write("page.md", page(""));
  EXPECT_THROW(write_between(folder() / "page.md", load, "new\n"), InputError)
      << "the next end is another section's";
}

}  // namespace
}  // namespace tureen::test
