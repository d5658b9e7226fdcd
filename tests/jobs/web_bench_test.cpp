// Downloads of bench.html: the results that they become, and the errors.
#include "jobs/bench/web_bench.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "base/error.hpp"
#include "cli/bench/bench_table.hpp"
#include "tests/support/errors.hpp"

namespace tureen::results {
namespace web_bench_test {

using test::error_of;
using test::ErrorAt;
using test::ErrorIn;
using test::Names;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using Pointer = nlohmann::json::json_pointer;

nlohmann::json fixture() {
  std::ifstream stream(std::string(TUREEN_SOURCE_DIR) + "/tests/jobs/web_bench.json");
  return nlohmann::json::parse(stream);
}

std::vector<BenchResult> read(const std::string& text) {
  Input input = Input::memory("phone.json", std::as_bytes(std::span(text)));
  return read_web_bench(input);
}
std::vector<BenchResult> read(const nlohmann::json& document) { return read(document.dump()); }

auto refusal(const std::string& text) {
  return error_of([&] { read(text); });
}

TEST(WebBench, SaysWhatThePageMeasured) {
  const std::vector<BenchResult> results = read(fixture());
  ASSERT_EQ(results.size(), 1u);
  const BenchResult& result = results.front();
  EXPECT_EQ(result.date, "2026-11-22T03:04:05Z");
  EXPECT_EQ(result.program.commit, "abc1234");
  EXPECT_EQ(result.scene.name, "ficus");
  EXPECT_EQ(result.scene.path, "scenes/ficus.glb");
  EXPECT_EQ(result.scene.triangles, 33417u);
  EXPECT_EQ(result.machine.cpu, fixture()["device"]["user_agent"].get<std::string>());
  EXPECT_EQ(result.machine.cores, 8);
  EXPECT_EQ(result.device.renderer, "Adreno (TM) 740");
  EXPECT_THAT(result.device.context, Names("WebGL2", 2.75, "393 x 851"));
  EXPECT_FALSE(result.device.software);
  EXPECT_EQ(result.protocol.clock, fixture()["protocol"]["clock"].get<std::string>());
  EXPECT_EQ(result.load.read_ms, 81.5);
  EXPECT_EQ(result.load.plan_ms, 12.25);
  EXPECT_EQ(result.load.peak_mib, 0) << "the page does not measure it";
  EXPECT_EQ(result.peak_mib, 64);
  EXPECT_EQ(result.load.device_mib, 45);
  EXPECT_EQ(result.configurations.at(1).device_mib, 66.5);
  EXPECT_THAT(result.notes, ElementsAre(Names("bench.html?scenes=ficus.glb"),
                                        fixture()["scenes"][0]["notes"][0].get<std::string>()));
}

TEST(WebBench, JudgesTimesByTheStatisticsOfEveryBenchmark) {
  const BenchResult result = read(fixture()).front();
  ASSERT_EQ(result.measurements.size(), 3u);
  const BenchMeasurement& ours = result.measurements[0];
  EXPECT_EQ(ours.configuration, "tureen");
  EXPECT_EQ(ours.size, "1280x720");
  EXPECT_EQ(ours.views, 3);
  EXPECT_EQ(ours.frame_ms.rounds, 3);
  EXPECT_EQ(ours.frames_per_sample, 4);
  EXPECT_EQ(ours.frames, 36);
  const FrameTimes times{.views = 3, .ms = {2, 3, 4, 2.5, 3.5, 4.5, 2.2, 3.2, 4.2}};
  const FrameStatistics wanted = statistics_of(times);
  EXPECT_EQ(ours.frame_ms.mean, wanted.mean);
  EXPECT_EQ(ours.frame_ms.p95, wanted.p95);
  EXPECT_EQ(ours.frame_ms.spread, wanted.spread);
  EXPECT_EQ(ours.frame_ms.min_of_medians, 3);
  EXPECT_EQ(ours.fps, 1000 / wanted.mean);
  EXPECT_THAT(ours.views_ms, ElementsAre(2.2, 3.2, 4.2));
  EXPECT_EQ(ours.aa_spread, 0.0625);
  EXPECT_TRUE(ours.stable);
  EXPECT_EQ(ours.pixels_hash, "0123456789abcdef");
  EXPECT_EQ(result.measurements[1].configuration, "published");
  EXPECT_FALSE(result.measurements[1].stable);
  EXPECT_EQ(result.measurements[2].size, "640x360");
  EXPECT_EQ(result.measurements[2].aa_spread, 0);
  EXPECT_EQ(result.protocol.rounds, 3);
  EXPECT_EQ(result.protocol.aa_spread, 0.0625);
  EXPECT_THAT(cli::bench_table(result), Contains(MatchesRegex(".* 3.00 +3.23 .*")));
}

TEST(WebBench, HasTheSpecialisationsOfItsPlans) {
  EXPECT_THAT(read(fixture()).front().configurations.at(0).specialisations, IsEmpty())
      << "an earlier version of the page";
  nlohmann::json page = fixture();
  page["scenes"][0]["configurations"][0]["specialisations"] = {
      {{"name", "alpha-test"}, {"count", 7}, {"total", 9}, {"margin", 0.25}}};
  EXPECT_THAT(read(page).front().configurations.at(0).specialisations,
              ElementsAre(AppliedSpecialisation{Specialisation::alpha_test, 7, 9, 0.25}));
}

TEST(WebBench, BecomesAResultLikeAnyOther) {
  nlohmann::json two = fixture();
  two["scenes"].push_back(two["scenes"][0]);
  two["scenes"][1]["name"] = "fox";
  const std::vector<BenchResult> results = read(two);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[1].scene.name, "fox");
  for (const BenchResult& result : results) {
    const Json json = to_json(result);
    EXPECT_EQ(to_json(bench_result_from_json(json.dump(), "bench.json")), json);
  }
}

// ---- Hostile files ------------------------------------------------------------------------------

/// The path of every value, object and list in the document.
std::vector<Pointer> all_places(const nlohmann::json& document) {
  std::set<std::string> places;
  const nlohmann::json flat = document.flatten();
  for (const auto& [path, value] : flat.items())
    for (Pointer pointer(path); !pointer.empty(); pointer.pop_back())
      places.insert(pointer.to_string());
  return {places.begin(), places.end()};
}

/// Expects that the reader rejects the document and names the file.
void expect_refused(const nlohmann::json& document, const std::string& what) {
  SCOPED_TRACE(what);
  EXPECT_THAT(refusal(document.dump()), ErrorIn("phone.json"));
}

TEST(WebBench, EveryKeyIsNeeded) {
  const nlohmann::json complete = fixture();
  std::size_t keys = 0;
  for (const Pointer& place : all_places(complete)) {
    if (!complete.at(place.parent_pointer()).is_object()) continue;
    nlohmann::json document = complete;
    document.at(place.parent_pointer()).erase(place.back());
    expect_refused(document, "without " + place.to_string());
    ++keys;
  }
  EXPECT_GT(keys, 40u);
}

TEST(WebBench, EveryValueIsOfItsKind) {
  const nlohmann::json complete = fixture();
  for (const Pointer& place : all_places(complete)) {
    for (const nlohmann::json& other :
         {nlohmann::json(true), nlohmann::json("text"), nlohmann::json(nullptr),
          nlohmann::json::object(), nlohmann::json::array()}) {
      // Some texts may have any value, and some lists may be empty.
      if (other.type() == complete.at(place).type()) continue;
      nlohmann::json document = complete;
      document.at(place) = other;
      expect_refused(document, place.to_string() + " as " + other.dump());
    }
    if (complete.at(place).is_number()) {
      nlohmann::json document = complete;
      document.at(place) = -1;
      expect_refused(document, place.to_string() + " negative");
      document.at(place) = 1e300;
      EXPECT_THAT(refusal(document.dump()), ErrorIn("phone.json")) << place;
    }
  }
}

TEST(WebBench, NamesWhatIsWrong) {
  EXPECT_THAT(refusal(""), ErrorAt("phone.json@0"));
  EXPECT_THAT(refusal("{\"format\": NaN}"), ErrorIn("phone.json", "NaN"));
  EXPECT_THAT(refusal("[]"), ErrorAt("phone.json"));
  EXPECT_THAT(refusal("{\"format\": \"tureen bench\"}"), ErrorAt("phone.json", "bench.html"));
  EXPECT_THAT(refusal(std::string(100000, '[')), ErrorIn("phone.json"));
  const auto changed = [](const char* place, const nlohmann::json& value) {
    nlohmann::json document = fixture();
    document.at(Pointer(place)) = value;
    return refusal(document.dump());
  };
  const auto wrong = [](const auto&... values) { return ErrorAt("phone.json", values...); };
  EXPECT_THAT(changed("/version", 2), wrong("version", 2));
  EXPECT_THAT(changed("/date", "today"), wrong("date"));
  EXPECT_THAT(changed("/device/pixel_ratio", 0), wrong("device.pixel_ratio"));
  EXPECT_THAT(changed("/scenes", nlohmann::json::array()), wrong("scenes"));
  const std::string first = "scenes[0].measurements[0].";
  const std::string at = "/scenes/0/measurements/0";
  EXPECT_THAT(changed((at + "/entrants/0/frame_ms/1/2").c_str(), -0.5),
              wrong(first + "entrants[0].frame_ms[1][2]", -0.5));
  EXPECT_THAT(changed((at + "/entrants/0/frame_ms/1/2").c_str(), 0),
              wrong(first + "entrants[0].frame_ms[1][2]"));
  EXPECT_THAT(changed((at + "/entrants/0/frame_ms/1").c_str(), {1, 2}),
              wrong(first + "entrants[0].frame_ms[1]", 2, 3));
  EXPECT_THAT(changed((at + "/entrants/1/frame_ms").c_str(), {{1, 2, 3}}),
              wrong(first + "entrants[1].frame_ms", 1, 3));
  EXPECT_THAT(changed((at + "/self_test_ms/1").c_str(), {{1, 2, 3}}),
              wrong(first + "self_test_ms[1]", 1, 2));
  EXPECT_THAT(changed((at + "/entrants/1/configuration").c_str(), "tureen"),
              wrong(first + "entrants[1].configuration"));
  EXPECT_THAT(changed((at + "/entrants/1/configuration").c_str(), "plaid"),
              wrong(first + "entrants[1].configuration"));
  EXPECT_THAT(changed((at + "/entrants/1/pixels_hash").c_str(), "0123456789ABCDEF"),
              wrong(first + "entrants[1].pixels_hash", 16));
  EXPECT_THAT(changed((at + "/frames_per_sample").c_str(), 2000000000),
              wrong(first + "frames_per_sample"));
  EXPECT_THAT(changed((at + "/width").c_str(), 0), wrong(first + "width", 0));
}

}  // namespace web_bench_test
}  // namespace tureen::results
