#include "jobs/tradeoff/panel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "jobs/timing/benchmark.hpp"
#include "jobs/tradeoff/references.hpp"

namespace tureen::tradeoff {

const char* name_of(Factor factor) { return factor_names[std::size_t(factor)]; }

bool is_judged(const Outcome& outcome) {
  return outcome.applied.quality.supersampling != antialiased_samples;
}

Candidates candidates(const Panel& panel) {
  Candidates result;
  for (std::size_t i = 0; i < panel.outcomes.size(); ++i) {
    const Outcome& outcome = panel.outcomes[i];
    if (outcome.factor != Factor::specialised || !is_judged(outcome)) continue;
    const double ms = outcome.ms.min_of_medians;
    // Only the A/A spread is used; there are too few rounds for a spread between rounds.
    result.points.push_back({.ms = ms,
                             .spread_ms = 2 * panel.aa_spread * ms,
                             .psnr_db = outcome.error.psnr_db,
                             .coverage_mismatch = outcome.error.coverage_mismatch,
                             .departures = outcome.departures()});
    result.index.push_back(i);
  }
  return result;
}

void find_ranges(Panel& panel) {
  for (std::size_t setting = 0; setting < panel.settings.size(); ++setting) {
    std::vector<double> ms, psnr_db;
    for (const Outcome& outcome : panel.outcomes) {
      const int others = outcome.departures() - (outcome.configuration[setting] != 0 ? 1 : 0);
      if (outcome.factor != Factor::specialised || others != 0) continue;
      ms.push_back(outcome.ms.min_of_medians);
      if (is_judged(outcome)) psnr_db.push_back(outcome.error.psnr_db);
    }
    const auto [fastest, slowest] = std::minmax_element(ms.begin(), ms.end());
    const auto [worst, best] = std::minmax_element(psnr_db.begin(), psnr_db.end());
    panel.ranges.push_back({setting, *slowest / *fastest, *best - *worst});
  }
}

std::vector<Configuration> combinations_of(Panel& panel, std::size_t most) {
  std::vector<SettingRange> ranges = panel.ranges;
  std::erase_if(ranges, [](const SettingRange& range) { return !range.matters(); });
  std::stable_sort(ranges.begin(), ranges.end(), [](const SettingRange& a, const SettingRange& b) {
    return std::log(a.time_ratio) * a.psnr_db > std::log(b.time_ratio) * b.psnr_db;
  });
  std::vector<std::size_t> varied;
  for (const SettingRange& range : ranges) varied.push_back(range.setting);
  if (varied.size() > 4) varied.resize(4);
  std::vector<Configuration> list = combinations(panel.settings, varied);
  while (list.size() > most) {
    varied.pop_back();
    list = combinations(panel.settings, varied);
  }
  if (varied.size() < ranges.size())
    panel.notes.push_back(fmt::format(
        "{} settings matter; {} (the limits are 4 settings and {} configurations)", ranges.size(),
        varied.size() < 2
            ? "no combination is measured"
            : fmt::format("only the {} with the largest effect on time and error are combined",
                          varied.size()),
        most));
  return list;
}

void find_front(Panel& panel) {
  const Candidates all = candidates(panel);
  for (const std::size_t i : pareto_front(all.points)) panel.front.push_back(all.index[i]);
}

bool is_on_front(const Panel& panel, std::size_t outcome) {
  return std::find(panel.front.begin(), panel.front.end(), outcome) != panel.front.end();
}

const Outcome* generic_of(const Panel& panel, const Outcome& outcome) {
  if (outcome.factor == Factor::baseline) return nullptr;
  for (const Outcome& other : panel.outcomes)
    if (other.factor == Factor::generic && other.configuration == outcome.configuration)
      return &other;
  return nullptr;
}

std::vector<std::string> warnings_about(const Outcome& outcome) {
  std::vector<std::string> warnings;
  if (!outcome.stable) warnings.emplace_back("its warm-up did not become stable before timing");
  if (outcome.error.non_finite > 0)
    warnings.push_back(fmt::format("{} pixels are not finite", outcome.error.non_finite));
  if (!is_judged(outcome))
    warnings.emplace_back(
        "drawn at the reference's samples: its error is only rounding, and it is not on the front");
  return warnings;
}

std::optional<std::string> spread_warning(double aa_spread) {
  if (aa_spread <= BenchmarkOptions{}.stable_within) return std::nullopt;
  return fmt::format(
      "two measurements of one configuration differ by {:.0f} %, so differences below {:.0f} % "
      "are not significant and another run may choose differently; use an idle machine, more "
      "--rounds or --processor-time",
      100 * aa_spread, 200 * aa_spread);
}

}  // namespace tureen::tradeoff
