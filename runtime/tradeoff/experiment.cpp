#include "runtime/tradeoff/experiment.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tureen::tradeoff {

namespace {

/// Whether `whole` turns every knob that `part` turns, and alike.
bool is_part_of(const Configuration& part, const Configuration& whole) {
  for (std::size_t knob = 0; knob < part.size(); ++knob)
    if (part[knob] != 0 && part[knob] != whole[knob]) return false;
  return true;
}

void add(Design& design, Configuration configuration, const Refusal& refuse) {
  const std::optional<std::string> reason = refuse(configuration);
  if (!reason) {
    design.configurations.push_back(std::move(configuration));
    return;
  }
  const auto says_it = [&](const Skipped& each) {
    return is_part_of(each.configuration, configuration);
  };
  if (std::none_of(design.skipped.begin(), design.skipped.end(), says_it))
    design.skipped.push_back({std::move(configuration), *reason});
}

/// The knob of a configuration of the star, none for the defaults.
std::optional<std::size_t> turned_knob(const Configuration& configuration) {
  for (std::size_t knob = 0; knob < configuration.size(); ++knob)
    if (configuration[knob] != 0) return knob;
  return {};
}

/// Combinations of these knobs that turn two of them or more: the others are in the star.
Design combinations(std::span<const int> settings, std::span<const KnobRange> knobs,
                    const Refusal& refuse) {
  Design design;
  // Counts through them as an odometer does, the last knob fastest: a part comes before its whole.
  Configuration configuration(settings.size(), 0);
  for (;;) {
    std::size_t at = knobs.size();
    while (at > 0 && ++configuration[knobs[at - 1].knob] == settings[knobs[at - 1].knob])
      configuration[knobs[--at].knob] = 0;
    if (at == 0) return design;
    if (departures(configuration) >= 2) add(design, configuration, refuse);
  }
}

}  // namespace

int departures(const Configuration& configuration) {
  return int(std::count_if(configuration.begin(), configuration.end(),
                           [](int setting) { return setting != 0; }));
}

Design star(std::span<const int> settings, const Refusal& refuse) {
  Design design;
  const Configuration defaults(settings.size(), 0);
  design.configurations.push_back(defaults);
  for (std::size_t knob = 0; knob < settings.size(); ++knob)
    for (int setting = 1; setting < settings[knob]; ++setting) {
      Configuration configuration = defaults;
      configuration[knob] = setting;
      add(design, std::move(configuration), refuse);
    }
  return design;
}

std::vector<KnobRange> knob_ranges(std::span<const Configuration> star,
                                   std::span<const Measured> measured, std::size_t knobs) {
  assert(!star.empty() && star.size() == measured.size() && departures(star[0]) == 0);
  std::vector<KnobRange> ranges(knobs);
  for (std::size_t knob = 0; knob < knobs; ++knob) {
    double fastest = measured[0].ms, slowest = measured[0].ms;
    double best = measured[0].psnr_db, worst = measured[0].psnr_db;
    for (std::size_t i = 1; i < star.size(); ++i) {
      if (turned_knob(star[i]) != knob) continue;
      if (!std::isnan(measured[i].ms)) {
        fastest = std::min(fastest, measured[i].ms);
        slowest = std::max(slowest, measured[i].ms);
      }
      if (!std::isnan(measured[i].psnr_db)) {
        best = std::max(best, measured[i].psnr_db);
        worst = std::min(worst, measured[i].psnr_db);
      }
    }
    ranges[knob] = {knob, slowest / fastest, best - worst};
  }
  return ranges;
}

Design factorial(std::span<const int> settings, std::span<const KnobRange> ranges,
                 const Refusal& refuse, const FactorialLimits& limits) {
  std::vector<KnobRange> chosen;
  for (const KnobRange& range : ranges)
    if (range.matters()) chosen.push_back(range);
  std::stable_sort(chosen.begin(), chosen.end(), [](const KnobRange& a, const KnobRange& b) {
    return std::log(a.time_ratio) * a.psnr_db > std::log(b.time_ratio) * b.psnr_db;
  });
  Reduction reduction{.mattering = chosen.size()};
  if (chosen.size() > limits.most_knobs) chosen.resize(limits.most_knobs);
  reduction.wanted = chosen.size();
  Design design = combinations(settings, chosen, refuse);
  reduction.configurations = design.configurations.size();
  while (design.configurations.size() > limits.most_configurations) {
    chosen.pop_back();
    design = combinations(settings, chosen, refuse);
  }
  reduction.combined = chosen.size();
  design.reduction = reduction;
  return design;
}

std::vector<std::string> describe(const Reduction& reduction, const FactorialLimits& limits) {
  std::vector<std::string> sentences;
  const auto& [mattering, wanted, configurations, combined] = reduction;
  if (wanted < mattering)
    sentences.push_back(std::to_string(mattering) + " knobs matter; the " + std::to_string(wanted) +
                        " that move time and error most are combined");
  if (combined < wanted)
    sentences.push_back(
        "all combinations of " + std::to_string(wanted) + " knobs are " +
        std::to_string(configurations) + " configurations, more than the limit of " +
        std::to_string(limits.most_configurations) + ": " +
        (combined < 2 ? std::string("none are measured")
                      : "only those of the first " + std::to_string(combined) + " are"));
  return sentences;
}

}  // namespace tureen::tradeoff
