// Program tests of `tureen bench`: its output, and whether the timed pixels equal those that
// `tureen render` draws.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

#include "formats/tureen_glb/tureen_glb.hpp"
#include "tests/cli/photographs_fixture.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen {
namespace bench_program_test {

using test::Child;
using test::ChildResult;
using test::Names;
using testing::AnyOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string example = TUREEN_SOURCE_DIR "/examples/soup.glb";

class Bench : public test::ProgramWithPhotographs {
 protected:
  /// Measures one round of two small views of the example. `more` are further arguments.
  ChildResult bench(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"bench", example, "--context", "osmesa"};
    if (std::find(more.begin(), more.end(), "--rounds") == more.end())
      arguments.insert(arguments.end(), {"--rounds", "1"});
    if (std::find(more.begin(), more.end(), "--size") == more.end())
      arguments.insert(arguments.end(), {"--size", "64x48"});
    if (std::find(more.begin(), more.end(), "--cameras") == more.end())
      arguments.insert(arguments.end(), {"--cameras", "orbit:2"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  nlohmann::json bench_json(std::vector<std::string> more = {}) const {
    more.push_back("--json");
    const ChildResult result = bench(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  }
  static std::vector<std::string> all(const nlohmann::json& list, const char* key) {
    std::vector<std::string> result;
    for (const auto& each : list) result.push_back(each[key]);
    return result;
  }
};

TEST_F(Bench, MeasuresTheSceneThatItNames) {
  const nlohmann::json json = bench_json({"--only", "tureen,triangles"});
  EXPECT_EQ(json["scene"]["triangles"], 7000);
  EXPECT_EQ(json["scene"]["path"], example);
  EXPECT_EQ(json["program"]["arguments"][0], "bench");
  EXPECT_EQ(json["device"]["software"], true);
  EXPECT_EQ(json["protocol"]["rounds"], 1);
  EXPECT_GE(json["peak_mib"], json["load"]["peak_mib"]) << "with the render targets";
  EXPECT_THAT(json["program"].value("build", ""), AnyOf("release", "debug", "sanitized"));
  for (const char* time :
       {"read_ms", "upload_ms", "peak_mib", "device_mib", "disk_mib", "memory_mib"})
    EXPECT_GT(json["load"][time], 0) << time;
  for (const auto& each : json["measurements"]) {
    EXPECT_EQ(each["width"], 64);
    EXPECT_EQ(each["height"], 48);
    EXPECT_EQ(each["views_ms"].size(), 2u);
    EXPECT_EQ(each["frames"], 2 * each["frames_per_sample"].get<int>());
    EXPECT_GT(each["frame_ms"]["min_of_medians"], 0);
    EXPECT_DOUBLE_EQ(each["fps"], 1000 / each["frame_ms"]["mean"].get<double>());
  }
}

class BenchOfSplats : public Bench {
 protected:
  static constexpr std::size_t count = 3000;

  void write_splats(const test::SplatKind& kind) const {
    Scene scene = scene_of(test::random_splats(kind, count, 0.1, 1));
    scene.layers[0].world_from_layer[0] = {0, 2, 0, 0};  // turned and scaled
    scene.layers[0].world_from_layer[1] = {-2, 0, 0, 0};
    scene.layers[0].world_from_layer[2] = {0, 0, 2, 0};
    write_tureen_glb(scene, folder / "splats.glb");
  }
  ChildResult bench_splats(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"bench",    "splats.glb", "--context", "osmesa",
                                       "--size",   "64x48",      "--cameras", "orbit:2",
                                       "--rounds", "1",          "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

class ThoroughBenchOfSplats : public BenchOfSplats {};

TEST_F(ThoroughBenchOfSplats, TimesThePlanAndItsOrder) {
  for (const test::SplatKind& kind : test::splat_kinds) {
    SCOPED_TRACE(kind.name);
    write_splats(kind);
    const ChildResult result = bench_splats({"-o", "timed"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["scene"]["splats"], count);
    EXPECT_EQ(json["scene"]["triangles"], 0);
    EXPECT_GT(json["load"]["peak_mib"], 0);
    // The baseline draws neither neural densities nor colours of corners nor discs.
    const std::string profile = kind.profile;
    const bool baseline =
        profile != "splatnet" && profile != "2dgs" && profile != "redisplats" && !kind.per_corner;
    std::vector<std::string> cases{"tureen", "raster", "generic"};
    if (baseline) cases.emplace_back("published");
    EXPECT_EQ(all(json["configurations"], "name"), cases);
    EXPECT_THAT(result.err, Names("3,000 splats: read"));
    EXPECT_EQ(result.err.find("published is skipped: the baseline supports") == std::string::npos,
              baseline);
    for (const auto& measured : json["measurements"]) {
      EXPECT_EQ(measured["frames_per_sample"], 1);
      EXPECT_GT(measured["order_ms"], 0);
      EXPECT_LT(measured["order_ms"], measured["frame_ms"]["mean"]);
    }
    for (std::size_t i = 0; i < cases.size(); ++i) {
      std::vector<std::string> render{"render",  "splats.glb",  "--context", "osmesa",
                                      "--orbit", "2",           "--size",    "64x48",
                                      "-o",      "drawn_%d.png"};
      const std::vector<std::string> options = json["configurations"][i]["options"];
      render.insert(render.end(), options.begin(), options.end());
      ASSERT_EQ(run(render).exit_code, 0);
      EXPECT_EQ(read_png(json["measurements"][i]["picture"]).pixels, read_png("drawn_1.png").pixels)
          << cases[i];
    }
  }
}

TEST_F(BenchOfSplats, TheWayToBlendCanBeChosen) {
  write_splats(test::splat_kinds[0]);
  const auto configurations = [&](const std::vector<std::string>& more) {
    const ChildResult result = bench_splats(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out)["configurations"];
  };
  const nlohmann::json raster = configurations({"--blend", "raster"});
  EXPECT_THAT(all(raster, "name"), ElementsAre("tureen", "generic", "published"));
  EXPECT_THAT(raster[0]["options"], ElementsAre("--blend", "raster"));
  EXPECT_THAT(raster[1]["options"], ElementsAre("--blend", "raster", "--no-specialise"));
  const nlohmann::json both = configurations({"--only", "raster,tiles"});
  EXPECT_THAT(both[0]["options"], ElementsAre("--blend", "raster"));
  EXPECT_THAT(both[1]["options"], ElementsAre("--blend", "tiles"));
  EXPECT_THAT(all(configurations({"--no-specialise"}), "name"), ElementsAre("generic"));
  EXPECT_THAT(all(configurations({"--pipeline", "baseline"}), "name"), ElementsAre("published"));
}

TEST_F(BenchOfSplats, WhatNeedsTrianglesIsRefused) {
  write_splats(test::splat_kinds[0]);
  for (const char* name : {"triangles", "tureen-fragment", "tureen-compute"})
    EXPECT_EQ(bench_splats({"--only", name}).exit_code, 2) << name;
  EXPECT_EQ(bench_splats({"--cameras", "adversarial"}).exit_code, 2);
  EXPECT_EQ(bench_splats({"--only", "tureen,copy"}).exit_code, 0);
  for (const char* name : {"raster", "tiles"})
    EXPECT_EQ(bench({"--only", name}).exit_code, 2) << name << " of triangles";
}

TEST_F(BenchOfSplats, WindowsAreTrianglesIfOpaque) {
  Scene scene = scene_of(test::random_splats(test::splat_kinds[0], count, 0.1, 1));
  write_tureen_glb(scene, folder / "splats.glb");
  const ChildResult result = bench_splats({"--opaque", "--only", "tureen,triangles"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["scene"]["splats"], 0);
  EXPECT_GT(json["scene"]["triangles"], 0);
  EXPECT_TRUE(json["measurements"][0]["order_ms"].is_null());
  EXPECT_EQ(json["configurations"][0]["options"], nlohmann::json({"--opaque"}));
}

TEST_F(Bench, SaysWithHowManyThreadsLlvmpipeDraws) {
  const std::vector<std::string> arguments{"--only", "tureen", "-o", "two"};
  setenv("LP_NUM_THREADS", "2", 1);
  const nlohmann::json two = bench_json(arguments);
  setenv("LP_NUM_THREADS", "1", 1);
  const nlohmann::json one = bench_json({"--only", "tureen", "--against", "two/bench.json"});
  unsetenv("LP_NUM_THREADS");
  ASSERT_THAT(two["device"]["renderer"].get<std::string>(), HasSubstr("llvmpipe"));
  EXPECT_EQ(two["machine"]["rasteriser_threads"], 2);
  EXPECT_THAT(
      one["comparison"]["changes"],
      Contains(nlohmann::json({{"what", "rasteriser_threads"}, {"then", "2"}, {"now", "1"}})));
}

TEST_F(Bench, SoftwareIsTimedByTheProcessorsClockAlone) {
  const ChildResult result = bench({"--only", "tureen", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json measured = nlohmann::json::parse(result.out);
  ASSERT_FALSE(measured["measurements"].empty());
  for (const auto& each : measured["measurements"]) {
    EXPECT_TRUE(each["passes_ms"].is_null());
    EXPECT_TRUE(each["gpu_ms"].is_null());
    EXPECT_EQ(each["passes_gap"], "no_timers");
    const std::string reason = each["passes_reason"];
    EXPECT_THAT(result.err, HasSubstr(reason));
  }
}

TEST_F(Bench, ThePixelsThatWereTimedAreThoseOfRender) {
  const nlohmann::json json = bench_json({"-o", "timed"});
  ASSERT_EQ(json["configurations"].size(), json["measurements"].size());
  for (std::size_t i = 0; i < json["measurements"].size(); ++i) {
    const auto& configuration = json["configurations"][i];
    const auto& measurement = json["measurements"][i];
    SCOPED_TRACE(configuration["name"].get<std::string>());
    std::vector<std::string> render{"render", example,  "--context", "osmesa", "--orbit",
                                    "2",      "--size", "64x48",     "-o",     "drawn_%d.png"};
    for (const std::string option : configuration["options"]) render.push_back(option);
    ASSERT_EQ(run(render).exit_code, 0);
    // The second view is timed last.
    EXPECT_EQ(read_png(measurement["picture"]).pixels, read_png("drawn_1.png").pixels);
    EXPECT_NE(read_png(measurement["picture"]).pixels, read_png("drawn_0.png").pixels);
  }
  std::ifstream file(folder / "timed/bench.json");
  EXPECT_EQ(nlohmann::json::parse(file), json);
  EXPECT_EQ(all(json["measurements"], "configuration"), all(json["configurations"], "name"));
}

TEST_F(Bench, WhatIsKeptIsSaidAsAnOptionOfRender) {
  const nlohmann::json json = bench_json({"--keep", "background,alpha-test"});
  EXPECT_THAT(json["configurations"][0]["options"], ElementsAre("--keep", "alpha-test,background"));
  EXPECT_THAT(json["configurations"][1]["options"], ElementsAre("--no-specialise"));
  const auto applied = all(json["configurations"][0]["specialisations"], "name");
  EXPECT_THAT(applied, Not(testing::IsEmpty()));
  EXPECT_THAT(applied, Not(Contains("background")));
  EXPECT_THAT(applied, Not(Contains("alpha-test")));
}

TEST_F(Bench, ProcessorTimeIsSaidWhereItIsWhatWasMeasured) {
  const nlohmann::json protocol = bench_json({"--processor-time", "--only", "tureen"})["protocol"];
  EXPECT_EQ(protocol["processor_time"], true);
  const std::string clock = protocol["clock"];
  const ChildResult steady = bench({"--only", "tureen", "--json"});
  const std::string other = nlohmann::json::parse(steady.out)["protocol"]["clock"];
  EXPECT_NE(clock, other);
  EXPECT_THAT(steady.err, HasSubstr(other));
}

TEST_F(Bench, ConfigurationsCanBeChosen) {
  EXPECT_THAT(all(bench_json()["configurations"], "name"),
              ElementsAre("tureen", "generic", "published"));
  EXPECT_THAT(all(bench_json({"--no-specialise"})["configurations"], "name"),
              ElementsAre("generic"));
  EXPECT_THAT(all(bench_json({"--pipeline", "baseline"})["configurations"], "name"),
              ElementsAre("published"));
  const nlohmann::json ceilings = bench_json({"--only", "tureen", "--ceilings"});
  EXPECT_THAT(all(ceilings["configurations"], "name"), ElementsAre("tureen", "triangles", "copy"));
  EXPECT_NE(ceilings["measurements"][0]["pixels_hash"], ceilings["measurements"][1]["pixels_hash"]);
}

TEST_F(Bench, EitherShadingStageCanBeTimed) {
  const nlohmann::json json = bench_json({"--only", "tureen-fragment,tureen-compute"});
  EXPECT_THAT(json["configurations"][0]["options"], ElementsAre("--shading", "fragment"));
  EXPECT_THAT(json["configurations"][1]["options"], ElementsAre("--shading", "compute"));
  EXPECT_EQ(json["measurements"][0]["pixels_hash"], json["measurements"][1]["pixels_hash"]);
  const nlohmann::json asked = bench_json({"--shading", "compute"})["configurations"];
  EXPECT_THAT(asked[0]["options"], ElementsAre("--shading", "compute"));
  EXPECT_THAT(asked[1]["options"], ElementsAre("--shading", "compute", "--no-specialise"));
  EXPECT_THAT(asked[2]["options"], ElementsAre("--pipeline", "baseline"));
}

TEST_F(Bench, ASceneThatTheBaselineCannotDrawIsTimedWithoutIt) {
  write_scene();
  const ChildResult result = run(
      {"bench", "scene.off", "--context", "osmesa", "--rounds", "1", "--size", "32x32", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_THAT(all(json["configurations"], "name"), ElementsAre("tureen", "generic"));
  EXPECT_THAT(result.err, Names("published"));
  EXPECT_EQ(json["measurements"][0]["views"], 8);
  EXPECT_EQ(json["measurements"][0]["camera_set"], "hemisphere:8");
  EXPECT_EQ(run({"bench", "scene.off", "--only", "published"}).exit_code, 2);
}

TEST_F(Bench, SetsAndSizesMakeATableEach) {
  const ChildResult result = bench(
      {"--cameras", "adversarial,orbit:3", "--size", "48x27,32x18", "--only", "tureen", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_THAT(all(json["measurements"], "size"), ElementsAre("32x18", "32x18", "48x27", "48x27"));
  EXPECT_THAT(all(json["measurements"], "camera_set"),
              ElementsAre("adversarial", "orbit:3", "adversarial", "orbit:3"));
  EXPECT_EQ(json["measurements"][0]["views"], 4);
  EXPECT_THAT(result.err, Names("32 x 18", "adversarial", "48 x 27", "orbit:3"));
}

TEST_F(Bench, RecordedCamerasComeInFullHalfAndQuarter) {
  const std::string own = example;  // the example has cameras
  const nlohmann::json json =
      bench_json({"--cameras", own + ":0", "--size", "quarter,64x48", "--only", "tureen"});
  ASSERT_EQ(json["measurements"].size(), 2u);
  const auto drawn = run({"render", example, "--camera", own + ":0", "--json"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  const auto full = nlohmann::json::parse(drawn.out);
  for (const auto& each : json["measurements"]) {
    if (each["size"] == "64x48") continue;
    EXPECT_EQ(each["size"], "quarter");
    EXPECT_EQ(each["width"], full["width"].get<int>() / 4);
    EXPECT_EQ(each["height"], full["height"].get<int>() / 4);
  }
}

TEST_F(Bench, ADatasetGivesItsCamerasAndTheirSizes) {
  photograph(example);
  const ChildResult result = run({"bench", example, "data", "--sizes", "full,half", "--only",
                                  "tureen", "--context", "osmesa", "--rounds", "1", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_THAT(all(json["measurements"], "size"), ElementsAre("half", "full"));
  const auto& half = json["measurements"][0];
  const auto& full = json["measurements"][1];
  EXPECT_EQ(full["width"], width);
  EXPECT_EQ(half["height"], height / 2);
  EXPECT_EQ(full["views"], 2);  // the test split
}

struct Refusal {
  std::vector<std::string> arguments;
  int exit_code;
  const char* names;  // a value in the message
};

TEST_F(Bench, RefusesWhatMakesNoSense) {
  const Refusal refusals[] = {
      {{"--cameras", "hemispher"}, 2, "hemispher"},
      {{"--cameras", "orbit:0"}, 2, "orbit:0"},
      {{"--cameras", "dataset"}, 2, "DATASET"},
      {{"--size", "half"}, 2, "'half'"},
      {{"--size", "64"}, 2, "'64'"},
      {{"--only", "publish"}, 2, "published"},
      {{"--only", "copy,copy"}, 2, "copy"},
      {{"no_dataset", "--cameras", "dataset"}, 3, "no_dataset"},
      {{"--against", "old.json", "--fail-slower", "5"}, 2, "--fail-slower"},
  };
  for (const Refusal& refusal : refusals) {
    SCOPED_TRACE(refusal.names);
    const ChildResult result = bench(refusal.arguments);
    EXPECT_EQ(result.exit_code, refusal.exit_code);
    EXPECT_THAT(result.err, HasSubstr(refusal.names));
    EXPECT_EQ(result.out, "");
  }
}

TEST_F(Bench, TimeIsKeptTo) {
  // A thousand rounds of these would take minutes.
  const nlohmann::json json =
      bench_json({"--rounds", "1000", "--seconds", "1", "--size", "320x180", "--only", "tureen"});
  EXPECT_LT(json["measurements"][0]["rounds"], 1000);
  EXPECT_GE(json["measurements"][0]["rounds"], 1);
}

TEST_F(Bench, CtrlCLeavesNoResult) {
  Child child({"bench", example, "--context", "osmesa", "--only", "tureen", "--size", "64x48",
               "--seconds", "0", "--rounds", "10000", "-o", "timed"},
              folder);
  ASSERT_TRUE(child.wait_until([&] { return child.has_loaded("libOSMesa"); }));
  child.signal(SIGINT);
  const ChildResult result = child.wait();
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_FALSE(exists("timed/bench.json"));
}

}  // namespace bench_program_test
}  // namespace tureen
