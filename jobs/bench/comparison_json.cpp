#include "jobs/bench/comparison_json.hpp"

#include <fmt/format.h>

#include <array>

namespace tureen::results {

namespace {

using What = BenchChange::What;

std::string described(const BenchMeasurement& m) {
  const std::string pixels = fmt::format("{}x{}", m.width, m.height);
  return fmt::format("{}, {}, {}", m.configuration, m.camera_set,
                     m.size == pixels ? pixels : m.size + " (" + pixels + ")");
}

const char* name_of(Incomparable reason) {
  return reason == Incomparable::software ? "software" : "clock";
}

/// JSON values, in the order of BenchChange::What.
constexpr std::array<const char*, 8> change_names{
    "scene", "machine", "driver", "context", "rasteriser_threads", "build", "commit", "clock"};

std::string describe(Incomparable reason) {
  return reason == Incomparable::software ? "not compared: one of the two used a software renderer"
                                          : "not compared: the two used different clocks";
}

std::string describe(const BenchChange& change) {
  const char* what = change.what == What::rasteriser_threads
                         ? "number of rasteriser threads"
                         : change_names[std::size_t(change.what)];
  return fmt::format("different {}: {} then, {} now", what, change.then, change.now);
}

std::string describe(const UnmatchedBench& unmatched) {
  return (unmatched.in == UnmatchedBench::In::now ? "only now: " : "only then: ") +
         described(unmatched.measurement);
}

}  // namespace

std::vector<std::string> circumstances(const BenchComparison& comparison) {
  std::vector<std::string> sentences;
  if (comparison.incomparable) sentences.push_back(describe(*comparison.incomparable));
  for (const BenchChange& change : comparison.changes) sentences.push_back(describe(change));
  return sentences;
}

std::vector<std::string> unmatched_lines(const BenchComparison& comparison) {
  std::vector<std::string> lines;
  for (const UnmatchedBench& each : comparison.unmatched) lines.push_back(describe(each));
  return lines;
}

Json to_json(const BenchComparison& comparison, const std::string& against) {
  Json ratios = Json::array();
  for (const BenchRatio& ratio : comparison.ratios)
    ratios.push_back({{"configuration", ratio.configuration},
                      {"camera_set", ratio.camera_set},
                      {"size", ratio.size},
                      {"then_ms", ratio.then_ms},
                      {"now_ms", ratio.now_ms},
                      {"ratio", ratio.ratio},
                      {"spread", ratio.spread ? Json(*ratio.spread) : Json()},
                      {"rounds", ratio.rounds},
                      {"verdict", name_of(ratio.verdict)},
                      {"same_pixels", ratio.same_pixels}});
  Json changes = Json::array();
  for (const BenchChange& change : comparison.changes)
    changes.push_back({{"what", change_names[std::size_t(change.what)]},
                       {"then", change.then},
                       {"now", change.now}});
  const std::optional<Incomparable>& reason = comparison.incomparable;
  return {{"against", against},
          {"incomparable", reason ? Json(name_of(*reason)) : Json()},
          {"ratios", std::move(ratios)},
          {"changes", std::move(changes)},
          {"circumstances", circumstances(comparison)},
          {"unmatched", unmatched_lines(comparison)}};
}

}  // namespace tureen::results
