#include "jobs/tradeoff/experiment.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tureen::tradeoff {

namespace {

/// Whether `whole` has every value of `part` that is not a default.
bool is_part_of(const Configuration& part, const Configuration& whole) {
  for (std::size_t setting = 0; setting < part.size(); ++setting)
    if (part[setting] != 0 && part[setting] != whole[setting]) return false;
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

/// The changed setting in a configuration of the star; nullopt for the defaults.
std::optional<std::size_t> changed_setting(const Configuration& configuration) {
  for (std::size_t setting = 0; setting < configuration.size(); ++setting)
    if (configuration[setting] != 0) return setting;
  return {};
}

/// Combinations that change at least two of these settings; the others are in the star.
Design combinations(std::span<const int> value_counts, std::span<const SettingRange> settings,
                    const Refusal& refuse) {
  Design design;
  // Counts like an odometer, with the last setting fastest. A configuration therefore comes after
  // all its parts.
  Configuration configuration(value_counts.size(), 0);
  for (;;) {
    std::size_t at = settings.size();
    while (at > 0 &&
           ++configuration[settings[at - 1].setting] == value_counts[settings[at - 1].setting])
      configuration[settings[--at].setting] = 0;
    if (at == 0) return design;
    if (departures(configuration) >= 2) add(design, configuration, refuse);
  }
}

}  // namespace

int departures(const Configuration& configuration) {
  return int(std::count_if(configuration.begin(), configuration.end(),
                           [](int value) { return value != 0; }));
}

Design star(std::span<const int> value_counts, const Refusal& refuse) {
  Design design;
  const Configuration defaults(value_counts.size(), 0);
  design.configurations.push_back(defaults);
  for (std::size_t setting = 0; setting < value_counts.size(); ++setting)
    for (int value = 1; value < value_counts[setting]; ++value) {
      Configuration configuration = defaults;
      configuration[setting] = value;
      add(design, std::move(configuration), refuse);
    }
  return design;
}

std::vector<SettingRange> setting_ranges(std::span<const Configuration> star,
                                         std::span<const Measured> measured, std::size_t settings) {
  assert(!star.empty() && star.size() == measured.size() && departures(star[0]) == 0);
  std::vector<SettingRange> ranges(settings);
  for (std::size_t setting = 0; setting < settings; ++setting) {
    double fastest = measured[0].ms, slowest = measured[0].ms;
    double best = measured[0].psnr_db, worst = measured[0].psnr_db;
    for (std::size_t i = 1; i < star.size(); ++i) {
      if (changed_setting(star[i]) != setting) continue;
      if (!std::isnan(measured[i].ms)) {
        fastest = std::min(fastest, measured[i].ms);
        slowest = std::max(slowest, measured[i].ms);
      }
      if (!std::isnan(measured[i].psnr_db)) {
        best = std::max(best, measured[i].psnr_db);
        worst = std::min(worst, measured[i].psnr_db);
      }
    }
    ranges[setting] = {setting, slowest / fastest, best - worst};
  }
  return ranges;
}

Design factorial(std::span<const int> value_counts, std::span<const SettingRange> ranges,
                 const Refusal& refuse, const FactorialLimits& limits) {
  std::vector<SettingRange> chosen;
  for (const SettingRange& range : ranges)
    if (range.matters()) chosen.push_back(range);
  std::stable_sort(chosen.begin(), chosen.end(), [](const SettingRange& a, const SettingRange& b) {
    return std::log(a.time_ratio) * a.psnr_db > std::log(b.time_ratio) * b.psnr_db;
  });
  Reduction reduction{.mattering = chosen.size()};
  if (chosen.size() > limits.max_settings) chosen.resize(limits.max_settings);
  reduction.wanted = chosen.size();
  Design design = combinations(value_counts, chosen, refuse);
  reduction.configurations = design.configurations.size();
  while (design.configurations.size() > limits.max_configurations) {
    chosen.pop_back();
    design = combinations(value_counts, chosen, refuse);
  }
  reduction.combined = chosen.size();
  design.reduction = reduction;
  return design;
}

std::vector<std::string> describe(const Reduction& reduction, const FactorialLimits& limits) {
  std::vector<std::string> sentences;
  const auto& [mattering, wanted, configurations, combined] = reduction;
  if (wanted < mattering)
    sentences.push_back(std::to_string(mattering) + " settings matter; the " +
                        std::to_string(wanted) +
                        " with the largest effect on time and error are combined");
  if (combined < wanted)
    sentences.push_back(
        "all combinations of " + std::to_string(wanted) + " settings are " +
        std::to_string(configurations) + " configurations, more than the limit of " +
        std::to_string(limits.max_configurations) + ": " +
        (combined < 2 ? std::string("no combination is measured")
                      : "only those of the first " + std::to_string(combined) + " are measured"));
  return sentences;
}

}  // namespace tureen::tradeoff
