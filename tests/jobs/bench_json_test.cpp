// The file of `tureen bench`: written, read back, and rejected if invalid.
#include "jobs/bench/bench_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "base/error.hpp"
#include "tests/support/errors.hpp"

namespace tureen::results {
namespace bench_json_test {

/// A result with every field set, each to a value that no other field has.
BenchResult example() {
  BenchMeasurement hardware{.configuration = "tureen",
                            .camera_set = "hemisphere:3",
                            .size = "640x360",
                            .width = 640,
                            .height = 360,
                            .views = 3,
                            .frames_per_sample = 7,
                            .frames = 840,
                            .frame_ms = {.mean = 0.1,
                                         .median = 0.2,
                                         .p95 = 0.3,
                                         .p99 = 1.0 / 3,
                                         .min_of_medians = 0.15,
                                         .spread = 0.01,
                                         .low_1_percent_fps = 2999.5,
                                         .rounds = 40,
                                         .samples = 120},
                            .fps = 10000,
                            .aa_spread = 0.004,
                            .stable = true,
                            .passes_ms = {{"visibility", 0.04}, {"shading", 0.05}, {"blit", 0.001}},
                            .passes_gap = PassTimesGap::none,
                            .passes_reason = "",
                            .gpu_ms = 0.091,
                            .order_ms = 0.25,
                            .views_ms = {0.1, 0.2, 0.3},
                            .pixels_hash = "0123456789abcdef",
                            .image = "out/tureen_640x360.png"};
  BenchMeasurement software = hardware;
  software.configuration = "published";
  software.stable = false;
  software.passes_ms.clear();
  software.passes_gap = PassTimesGap::no_timers;
  software.passes_reason = "timers mislead on llvmpipe";
  software.gpu_ms.reset();
  software.order_ms.reset();
  software.image.reset();
  return {.date = "2026-01-02T03:04:05Z",
          .program = {.version = "0.1.0",
                      .commit = "abc1234",
                      .arguments = {"bench", "a.glb"},
                      .build = "debug"},
          .scene = {.name = "a",
                    .path = "x/a.glb",
                    .triangles = 15000,
                    .appearance = "lattice",
                    .splats = 20000},
          .machine = {.cpu = "Some CPU", .cores = 2, .memory_mib = 4096.5, .rasteriser_threads = 3},
          .device = {.context = "EGL, OpenGL 4.5 core",
                     .renderer = "llvmpipe",
                     .vendor = "Mesa",
                     .version = "4.5",
                     .software = true},
          .protocol = {.clock = "steady", .rounds = 5, .aa_spread = 0.02},
          .load = {.read_ms = 1,
                   .plan_ms = 2,
                   .upload_ms = 3,
                   .peak_mib = 4,
                   .device_mib = 5,
                   .disk_mib = 6,
                   .memory_mib = 7},
          .configurations = {{.name = "tureen",
                              .options = {},
                              .plan = {"color-mlp: the color MLP does not run"},
                              .plan_ms = 2,
                              .upload_ms = 3,
                              .device_mib = 5,
                              .specialisations = {{Specialisation::color_mlp, 0, 0, 0.25},
                                                  {Specialisation::alpha_test, 7, 9}}},
                             {.name = "published",
                              .options = {"--pipeline", "published"},
                              .plan = {},
                              .plan_ms = 0.5,
                              .upload_ms = 6,
                              .device_mib = 7}},
          .measurements = {hardware, software},
          .notes = {"a note"},
          .peak_mib = 8.5};
}

TEST(BenchResult, ComesBackFromJsonAsItWas) {
  const Json written = to_json(example());
  const BenchResult read = bench_result_from_json(written.dump(), "bench.json");
  EXPECT_EQ(to_json(read), written);
  EXPECT_EQ(read.configurations[0].specialisations, example().configurations[0].specialisations);
  // The order of passes is their order in the frame.
  ASSERT_EQ(read.measurements[0].passes_ms.size(), 3u);
  EXPECT_EQ(read.measurements[0].passes_ms[0].first, "visibility");
  EXPECT_EQ(read.measurements[0].frame_ms.p99, 1.0 / 3);
  EXPECT_EQ(read.measurements[0].gpu_ms, 0.091);
  EXPECT_FALSE(read.measurements[1].gpu_ms);
  EXPECT_TRUE(read.measurements[1].passes_ms.empty());
  EXPECT_EQ(read.configurations[1].options[1], "published");
  EXPECT_EQ(read.measurements[0].frame_ms.rounds, 40);
  EXPECT_EQ(read.measurements[0].frame_ms.samples, 120u);
  EXPECT_EQ(read.program.build, "debug");
  EXPECT_EQ(read.machine.rasteriser_threads, 3);
  EXPECT_EQ(read.peak_mib, 8.5);
  EXPECT_EQ(read.scene.splats, 20000u);
  EXPECT_EQ(read.measurements[0].order_ms, 0.25);
  EXPECT_FALSE(read.measurements[1].order_ms);
}

TEST(BenchResult, OfTooFewSamplesTheSlowestPercentIsNull) {
  BenchResult few = example();
  for (BenchMeasurement& m : few.measurements) {
    m.frame_ms.rounds = 33;  // of three views
    m.frame_ms.samples = 99;
  }
  const Json written = to_json(few);
  EXPECT_TRUE(written["measurements"][0]["frame_ms"]["p99"].is_null());
  EXPECT_TRUE(written["measurements"][0]["low_1_percent_fps"].is_null());
  EXPECT_EQ(to_json(bench_result_from_json(written.dump(), "bench.json")), written);
}

/// A document of version 1.
nlohmann::json of_version_1() {
  nlohmann::json document = to_json(example());
  document["version"] = 1;
  document["program"].erase("build");
  document["machine"].erase("rasteriser_threads");
  document.erase("peak_mib");
  document["protocol"].erase("processor_time");
  document["measurements"][0]["rounds"] = 5;  // 15 samples; version 1 has a p99 nevertheless
  return document;
}

TEST(BenchResult, OlderFilesAreRead) {
  const BenchResult read = bench_result_from_json(of_version_1().dump(), "bench.json");
  EXPECT_EQ(read.program.build, "");
  EXPECT_FALSE(read.machine.rasteriser_threads);
  EXPECT_FALSE(read.peak_mib);
  EXPECT_FALSE(read.protocol.processor_time);
  EXPECT_EQ(read.measurements[0].frame_ms.p99, 1.0 / 3);
}

TEST(BenchResult, OlderFilesHaveProcessorTimeAsAnOption) {
  nlohmann::json document = of_version_1();
  document["program"]["arguments"].push_back("--processor-time");
  EXPECT_TRUE(bench_result_from_json(document.dump(), "bench.json").protocol.processor_time);
}

/// The path of every key in the document, as "measurements/0/frame_ms/mean".
std::vector<nlohmann::json::json_pointer> all_keys(const nlohmann::json& document) {
  std::vector<nlohmann::json::json_pointer> result;
  const nlohmann::json flat = document.flatten();
  for (const auto& [path, value] : flat.items()) {
    nlohmann::json::json_pointer pointer(path);
    for (; !pointer.empty(); pointer.pop_back())
      if (document.at(pointer.parent_pointer()).is_object()) result.push_back(pointer);
  }
  return result;
}

TEST(BenchResult, MissesEveryKeyThatAllHave) {
  const nlohmann::json complete = to_json(example());
  const auto keys = all_keys(complete);
  ASSERT_GT(keys.size(), 60u);
  const std::set<std::string> optional{"/program/build",  "/machine/rasteriser_threads",
                                       "/peak_mib",       "/protocol/processor_time",
                                       "/scene/splats",   "/load/disk_mib",
                                       "/load/memory_mib"};
  for (const auto& key : keys) {
    // Files of earlier versions have no list of specialisations, no kind of gap, no splats.
    if (optional.contains(key.to_string()) || key.back() == "specialisations" ||
        key.back() == "passes_gap" || key.back() == "order_ms")
      continue;
    nlohmann::json document = complete;
    document.at(key.parent_pointer()).erase(key.back());
    SCOPED_TRACE(key.to_string());
    EXPECT_THROW(bench_result_from_json(document.dump(), "bench.json"), InputError);
  }
}

TEST(BenchResult, RefusesAnotherKind) {
  const nlohmann::json complete = to_json(example());
  for (const auto& key : all_keys(complete)) {
    nlohmann::json document = complete;
    document.at(key) =
        document.at(key).is_boolean() ? nlohmann::json("text") : nlohmann::json(true);
    SCOPED_TRACE(key.to_string());
    EXPECT_THROW(bench_result_from_json(document.dump(), "bench.json"), InputError);
  }
}

TEST(BenchResult, NamesWhatIsWrong) {
  const auto refusal = [](const std::string& text) {
    return test::error_of([&] { bench_result_from_json(text, "bench.json"); });
  };
  const auto wrong = [](const auto&... values) { return test::ErrorAt("bench.json", values...); };
  EXPECT_THAT(refusal("{"), test::ErrorAt("bench.json@1"));
  EXPECT_THAT(refusal("[]"), wrong());
  EXPECT_THAT(refusal("{\"frames\": []}"), wrong("tureen bench"));
  nlohmann::json document = to_json(example());
  document["version"] = bench_result_version + 1;
  EXPECT_THAT(refusal(document.dump()), wrong("version", bench_result_version + 1));
  document = to_json(example());
  document["measurements"] = nlohmann::json::array();
  EXPECT_THAT(refusal(document.dump()), wrong("measurements"));
  document = to_json(example());
  document["measurements"][0]["passes_gap"] = "lunch";
  EXPECT_THAT(refusal(document.dump()), wrong("measurements[0].passes_gap", "lunch"));
  document = to_json(example());
  document["measurements"][1]["frame_ms"]["p95"] = "fast";
  EXPECT_THAT(refusal(document.dump()), wrong("measurements[1].frame_ms.p95"));
  document = to_json(example());
  document["measurements"][0]["frame_ms"]["min_of_medians"] = 0;
  EXPECT_THAT(refusal(document.dump()), wrong("measurements[0].frame_ms.min_of_medians", 0));
  document = to_json(example());
  document["measurements"][0]["frame_ms"]["spread"] = -5;
  EXPECT_THAT(refusal(document.dump()), wrong("measurements[0].frame_ms.spread", -5));
  document = to_json(example());
  document["measurements"][0]["frame_ms"]["p99"] = nullptr;
  EXPECT_THAT(refusal(document.dump()), wrong("measurements[0].frame_ms.p99"));
}

TEST(Machine, IsKnownAndTakesMemory) {
  const Machine machine = this_machine();
  EXPECT_GE(machine.cores, 1);
#ifdef __linux__
  EXPECT_NE(machine.cpu, "");
  EXPECT_GT(machine.memory_mib, peak_mib());
  EXPECT_GT(peak_mib(), 1);  // of this test, GoogleTest and all
#endif
}

/// Sets LP_NUM_THREADS to the given value, and restores it at the end of its life.
class LlvmpipeThreads {
 public:
  explicit LlvmpipeThreads(const char* value) {
    if (const char* old = std::getenv(name)) before_ = old;
    value ? setenv(name, value, 1) : unsetenv(name);
  }
  ~LlvmpipeThreads() { before_ ? setenv(name, before_->c_str(), 1) : unsetenv(name); }

 private:
  static constexpr const char* name = "LP_NUM_THREADS";
  std::optional<std::string> before_;
};

TEST(Machine, KnowsWithHowManyThreadsLlvmpipeDraws) {
  const std::string llvmpipe = "llvmpipe (LLVM 15.0.6, 256 bits)";
  const auto with = [&](const char* value) {
    const LlvmpipeThreads threads(value);
    return rasteriser_threads_of(llvmpipe);
  };
  const int cores = this_machine().cores;
  const int usual = cores > 1 ? cores : 0;
  EXPECT_EQ(with(nullptr), usual);
  EXPECT_EQ(with("7"), 7);
  EXPECT_EQ(with("0"), 0) << "the thread that calls OpenGL draws";
  EXPECT_EQ(with("many"), usual);
  EXPECT_EQ(with("-1"), usual);
  const LlvmpipeThreads threads("7");
  EXPECT_EQ(rasteriser_threads_of("a graphics card"), std::nullopt);
}

}  // namespace bench_json_test
}  // namespace tureen::results
