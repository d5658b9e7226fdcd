// Runs of several scenes joined: the arithmetic, by hand, and what becomes of it.
#include "cli/tradeoff_scenes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "cli/tradeoff_fixture.hpp"
#include "cli/tradeoff_reading.hpp"
#include "cli/tradeoff_scenes_report.hpp"
#include "formats/shown_text.hpp"
#include "soup/error.hpp"
#include "soup/metrics.hpp"

namespace tureen::cli {
namespace {

using nlohmann::json;
using test::chair;
using test::lego;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

/// Of some hundred operations on doubles of at most 1000.
constexpr double rounding = 1e-11;

TradeoffRun run_of(const std::string& file, const json& document) {
  const std::string text = document.dump();
  Input input = Input::memory(file, std::as_bytes(std::span(text)));
  return {file, read_tradeoff(input)};
}

TradeoffScenes join_both(const json& first, const json& second) {
  return join({run_of("a.json", first), run_of("b.json", second)});
}

std::vector<std::string> names(const Panel& panel) {
  std::vector<std::string> all;
  for (const Outcome& each : panel.outcomes) all.push_back(each.name);
  return all;
}

const Outcome& named(const Panel& panel, const std::string& name) {
  for (const Outcome& each : panel.outcomes)
    if (each.name == name) return each;
  throw std::runtime_error("there is no " + name);
}

std::string refusal(const json& first, const json& second) {
  try {
    join_both(first, second);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// The chair with a level 2 that takes half of its defaults instead of eight tenths.
json chair_with_fast_level() {
  json document = chair();
  document["drawing"]["configurations"][2]["ms"] = 20;
  return document;
}

TEST(TradeoffScenes, TimeIsAGeometricMeanOfRatios) {
  const TradeoffScenes scenes = join_both(lego(), chair_with_fast_level());
  const Panel& means = scenes.drawing.means;
  ASSERT_EQ(means.outcomes[2].name, "lattice level 2");
  // 8 of 10 ms and 20 of 40 ms: sqrt(0.8 * 0.5); as milliseconds sqrt(8 * 20) of sqrt(10 * 40).
  EXPECT_NEAR(time_ratio(means, 2), std::sqrt(0.4), rounding);
  EXPECT_NEAR(means.outcomes[2].ms.min_of_medians, std::sqrt(160), rounding);
  EXPECT_NEAR(means.outcomes[0].ms.min_of_medians, 20, rounding);
  EXPECT_EQ(time_ratio(means, 0), 1);
  // 1.5 times 8 and 32 ms.
  EXPECT_NEAR(means.outcomes[2].ms.p95, 1.5 * 16, rounding);
  EXPECT_NEAR(means.outcomes[2].ms.median, 1.1 * 16, rounding);
}

TEST(TradeoffScenes, AMachineTwiceAsFastChangesNoRatio) {
  json fast = chair_with_fast_level();
  for (json& each : fast["drawing"]["configurations"])
    if (!each["ms"].is_null()) each["ms"] = each["ms"].get<double>() / 2;
  const TradeoffScenes slow_scenes = join_both(lego(), chair_with_fast_level());
  const TradeoffScenes fast_scenes = join_both(lego(), fast);
  for (std::size_t i = 0; i < slow_scenes.drawing.means.outcomes.size(); ++i)
    if (slow_scenes.drawing.means.outcomes[i].has_time()) {
      EXPECT_NEAR(time_ratio(slow_scenes.drawing.means, i),
                  time_ratio(fast_scenes.drawing.means, i), rounding);
    }
}

TEST(TradeoffScenes, ErrorIsThePsnrOfTheGeometricMeanOfSquaredErrors) {
  const TradeoffScenes scenes = join_both(lego(), chair());
  const RenderError& error = named(scenes.drawing.means, "lattice level 2").error;
  // 40 and 30 dB: squared errors of 1e-4 and 1e-3.
  EXPECT_NEAR(error.psnr_db, psnr_from_mse(std::sqrt(1e-4 * 1e-3)), rounding);
  EXPECT_NEAR(error.psnr_db, 35, rounding);
  EXPECT_EQ(error.worst_psnr_db, 30);
  EXPECT_THAT(error.view_psnr_db, ElementsAre(40, 30));
  EXPECT_EQ(worst_scene(scenes, named(scenes.drawing.means, "lattice level 2")), "chair");
  EXPECT_EQ(scenes.drawing.means.ideal.psnr_db, 56);
  json damaged = lego();
  damaged["drawing"]["configurations"][2]["e_render"]["coverage"] = 0.25;
  EXPECT_EQ(join_both(damaged, chair()).drawing.means.outcomes[2].error.coverage_mismatch, 0.25);
}

TEST(TradeoffScenes, SpreadsAreJoinedAsIfAllErredInOneDirection) {
  json other = chair();
  other["drawing"]["aa_spread"] = 0.02;
  // The geometric mean of 1.08 and 1.04 is 1 + 2 * 0.0299057.
  EXPECT_NEAR(join_both(lego(), other).drawing.means.aa_spread, (std::sqrt(1.08 * 1.04) - 1) / 2,
              rounding);
  EXPECT_NEAR(join_both(lego(), chair()).drawing.means.aa_spread, 0.04, rounding);
}

TEST(TradeoffScenes, FrontAndHypervolumeAreThoseOfTheMeans) {
  const TradeoffScenes scenes = join_both(lego(), chair_with_fast_level());
  const Panel& means = scenes.drawing.means;
  EXPECT_THAT(names(means),
              ElementsAre("defaults", "published pipeline", "lattice level 2",
                          "shaded once a fragment", "defaults", "MLP in half floats"));
  // 12.65 ms at 35 dB and 20 ms at 55 dB; a fragment at a time takes 24 ms for the same 55 dB.
  EXPECT_THAT(means.front, ElementsAre(2, 0));
  EXPECT_NEAR(means.hypervolume,
              std::log10(100 / std::sqrt(160)) * (35 - 20) + std::log10(100 / 20.0) * (55 - 35),
              rounding);
  EXPECT_NEAR(scenes.antialiasing.means.hypervolume,
              std::log10(100 / 10.0) * (25 - 20) + std::log10(100 / 20.0) * (31 - 25), rounding);
  EXPECT_EQ(published_of(scenes.drawing)->error.psnr_db, 50);
  EXPECT_EQ(published_of(scenes.antialiasing), nullptr);
}

TEST(TradeoffScenes, AnEmulationHasAnErrorAndNoTime) {
  const TradeoffScenes scenes = join_both(lego(), chair());
  const Outcome& half = named(scenes.drawing.means, "MLP in half floats");
  EXPECT_EQ(half.method, Method::emulated);
  EXPECT_EQ(half.error.psnr_db, 54);
  const Json written = to_json(scenes)["drawing"]["configurations"][5];
  for (const char* key : {"time_ratio", "ms", "ms_p95"}) {
    EXPECT_EQ(written[key], nullptr) << key;
    EXPECT_EQ(written["scenes"][0][key], nullptr) << key;
  }
}

TEST(TradeoffScenes, WhatOneSceneLacksIsLeftOutAndSaid) {
  json other = chair();
  // No network, so no knob of its precision; and nothing published.
  other["drawing"]["knobs"].erase(2);
  other["drawing"]["configurations"].erase(5);
  other["drawing"]["configurations"].erase(1);
  for (json& each : other["drawing"]["configurations"]) each["knobs"].erase("mlp_precision");
  other["drawing"]["front"] = {1, 0};
  other["r0"] = nullptr;
  const TradeoffScenes scenes = join_both(lego(), other);
  EXPECT_THAT(names(scenes.drawing.means),
              ElementsAre("defaults", "lattice level 2", "shaded once a fragment", "defaults"));
  EXPECT_THAT(scenes.drawing.members[1], ElementsAre(2, 1));
  ASSERT_THAT(scenes.drawing.left_out, SizeIs(2));
  EXPECT_EQ(scenes.drawing.left_out[0].method, Method::published);
  EXPECT_THAT(scenes.drawing.left_out[0].lacking, ElementsAre(1));
  EXPECT_THAT(left_out_lines(scenes, scenes.drawing),
              ElementsAre("not in chair: published pipeline; MLP in half floats"));
  EXPECT_THAT(left_out_lines(scenes, scenes.antialiasing), IsEmpty());
}

TEST(TradeoffScenes, OfManyThatAreLeftOutEachIsSaidInALineThatIsShownWhole) {
  TradeoffScenes scenes = join_both(lego(), chair());
  scenes.drawing.left_out.clear();
  for (int i = 0; i < 100; ++i)
    scenes.drawing.left_out.push_back(
        {"way " + std::to_string(i) + " to draw", Method::specialised, {1}});
  std::string all;
  for (const std::string& line : left_out_lines(scenes, scenes.drawing)) {
    EXPECT_EQ(shown_line(line), line);
    all += line + "; ";
  }
  for (int i = 0; i < 100; ++i)
    EXPECT_THAT(all, HasSubstr("way " + std::to_string(i) + " to draw; "));
}

TEST(TradeoffScenes, WhatIsADepartureInOneSceneMayBeTheDefaultOfAnother) {
  json other = chair();
  // The chair is shaded once a fragment unless it is asked for otherwise.
  other["drawing"]["knobs"][1]["settings"] = {"forward", "deferred"};
  for (json& each : other["drawing"]["configurations"]) each["knobs"]["site"] = "forward";
  json& deferred = other["drawing"]["configurations"][3];
  deferred["knobs"]["site"] = "deferred";
  deferred["name"] = "shaded once a pixel";
  deferred["ms"] = 36;
  const TradeoffScenes scenes = join_both(lego(), other);
  const Panel& means = scenes.drawing.means;
  EXPECT_THAT(scenes.drawing.left_out, IsEmpty());
  EXPECT_NEAR(named(means, "shaded once a fragment").ms.min_of_medians, std::sqrt(12 * 40.),
              rounding);
  EXPECT_NEAR(named(means, "shaded once a pixel").ms.min_of_medians, std::sqrt(10 * 36.), rounding);
  // 18.97 and 20 ms differ by less than twice the spread of 4 %: the simpler is on the front.
  EXPECT_THAT(means.front, ElementsAre(2, 0));
}

/// As runs told it that had 8 x 8 samples on their front.
json with_supersampling(json document) {
  json& panel = document["antialiasing"];
  panel["knobs"].push_back({{"key", "supersampling"},
                            {"title", "supersampling"},
                            {"settings", {"1", "8"}},
                            {"time_ratio", 30},
                            {"psnr_range_db", 22},
                            {"matters", true}});
  json& all = panel["configurations"];
  for (json& each : all) each["knobs"]["supersampling"] = "1";
  all.push_back(all[0]);
  json& fine = all.back();
  fine["name"] = "8 x 8 samples a pixel";
  fine["knobs"]["supersampling"] = "8";
  for (const char* key : {"ms", "ms_median", "ms_p95"}) fine[key] = fine[key].get<double>() * 3;
  fine["e_render"]["psnr_db"] = 58;
  panel["front"].push_back(2);
  return document;
}

TEST(TradeoffScenes, TheReferencesOwnSamplesAreOnNoFront) {
  const TradeoffScenes scenes = join_both(with_supersampling(lego()), with_supersampling(chair()));
  const TradeoffScenes without = join_both(lego(), chair());
  EXPECT_THAT(scenes.antialiasing.means.front, ElementsAre(1, 0));
  EXPECT_EQ(scenes.antialiasing.means.hypervolume, without.antialiasing.means.hypervolume);
  EXPECT_THAT(scenes.notes, ElementsAre(StartsWith("8 x 8 samples a pixel: drawn at the "
                                                   "reference's own samples")));
}

TEST(TradeoffScenes, OrderOfTheFilesChangesNoMean) {
  json other = chair_with_fast_level();
  other["drawing"]["configurations"].erase(3);
  other["drawing"]["configurations"][1]["name"] = "as published";
  const TradeoffScenes one = join_both(lego(), other), two = join_both(other, lego());
  ASSERT_EQ(one.drawing.means.outcomes.size(), two.drawing.means.outcomes.size());
  for (std::size_t i = 0; i < one.drawing.means.outcomes.size(); ++i) {
    const Outcome &a = one.drawing.means.outcomes[i], &b = two.drawing.means.outcomes[i];
    EXPECT_EQ(a.configuration, b.configuration);
    EXPECT_NEAR(a.ms.min_of_medians, b.ms.min_of_medians, rounding);
    EXPECT_NEAR(a.error.psnr_db, b.error.psnr_db, rounding);
  }
  EXPECT_EQ(one.drawing.means.front, two.drawing.means.front);
  EXPECT_NEAR(one.drawing.means.hypervolume, two.drawing.means.hypervolume, rounding);
  EXPECT_NEAR(one.drawing.means.aa_spread, two.drawing.means.aa_spread, rounding);
  EXPECT_EQ(two.drawing.left_out[0].lacking, std::vector<std::size_t>{0});
}

TEST(TradeoffScenes, ASceneCountsOnce) {
  EXPECT_THAT(refusal(lego(), lego()),
              HasSubstr("b.json: scene: \"lego.glb\" is that of a.json, too; a scene counts once"));
  json same = chair();
  same["scene"]["name"] = "lego";
  same["scene"]["path"] = "./lego.glb";
  EXPECT_THAT(refusal(lego(), same), HasSubstr("a scene counts once"));
  // Every folder may have its soup.glb.
  same["scene"]["path"] = "chair/lego.glb";
  EXPECT_THAT(join_both(lego(), same).labels, ElementsAre("a.json", "b.json"));
}

TEST(TradeoffScenes, ErrorsAgainstOtherReferencesHaveNoMean) {
  json other = chair();
  other["protocol"]["samples"] = "exact";
  EXPECT_THAT(refusal(lego(), other),
              HasSubstr("b.json: protocol.samples: \"exact\", and \"device\" in a.json"));
}

TEST(TradeoffScenes, WhatRunsDoNotHaveInCommonIsSaid) {
  EXPECT_THAT(join_both(lego(), chair()).notes, IsEmpty());
  json other = chair();
  other["device"]["renderer"] = "a GPU";
  other["protocol"]["width"] = 128;
  EXPECT_THAT(join_both(lego(), other).notes,
              ElementsAre("the runs differ in their device: lego: llvmpipe; chair: a GPU",
                          "the runs differ in their size: lego: 96 x 64; chair: 128 x 64",
                          HasSubstr("time is relative to each run's own defaults")));
}

TEST(TradeoffScenes, WhatARunSaysAgainstItsTimesIsSaidAgain) {
  json other = chair();
  other["drawing"]["aa_spread"] = 1.06;
  other["drawing"]["configurations"][0]["warnings"] = {"did not come to rest"};
  EXPECT_THAT(join_both(lego(), other).notes,
              ElementsAre(HasSubstr("chair: one configuration differs from itself by 106 %"),
                          "chair, its defaults: did not come to rest"));
}

TEST(TradeoffScenesReport, HoldsMeansAndTheFiguresOfEachScene) {
  TradeoffScenes scenes = join_both(lego(), chair());
  scenes.date = "2026-06-01T12:00:00Z";
  const Json document = to_json(scenes);
  const Json& level = document["drawing"]["configurations"][2];
  EXPECT_EQ(level["settings"], (Json{{"lattice_level", "2"}}));
  EXPECT_EQ(level["worst_scene"], 1);
  EXPECT_NEAR(level["time_ratio"].get<double>(), 0.8, rounding);
  EXPECT_EQ(level["scenes"][1]["ms"], 32);
}

}  // namespace
}  // namespace tureen::cli
