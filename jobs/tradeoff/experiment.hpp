// Which configurations to measure: one setting at a time around the defaults (the star), then all
// combinations of the few settings that turned out to matter (the full factorial). Knows settings
// by their numbers alone; what they mean is jobs/tradeoff/quality_settings.hpp.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tureen::tradeoff {

/// The value of each setting, by its number; 0 is the default.
using Configuration = std::vector<int>;

/// How many settings are not at their default.
int departures(const Configuration& configuration);

/// Why a configuration cannot be drawn; nothing where it can.
using Refusal = std::function<std::optional<std::string>(const Configuration&)>;

struct Skipped {
  Configuration configuration;
  std::string reason;
};

/// What the limits of factorial() left of the settings that matter.
struct Reduction {
  std::size_t mattering = 0;       // settings
  std::size_t wanted = 0;          // of those, within FactorialLimits::max_settings
  std::size_t configurations = 0;  // all combinations of the wanted settings that can be drawn
  std::size_t combined = 0;        // settings left within FactorialLimits::max_configurations
};

struct Design {
  std::vector<Configuration> configurations;
  /// What cannot be drawn; of several of which one is part of the others, that one alone.
  std::vector<Skipped> skipped;
  Reduction reduction = {};
};

/// The defaults, then every other value of every setting alone. `value_counts` is how many each
/// setting has, at least 1. The defaults themselves must not be refused.
Design star(std::span<const int> value_counts, const Refusal& refuse);

/// The effect of one setting over its values.
struct SettingRange {
  std::size_t setting = 0;
  double time_ratio = 1;  // the slowest over the fastest
  double psnr_db = 0;     // the best minus the worst

  /// More than 5 % of time and more than 0.5 dB: a setting that moves one alone is no compromise,
  /// and is set without an experiment.
  bool matters() const { return time_ratio > 1.05 && psnr_db > 0.5; }
};

/// Time and error of a configuration of the star; NaN where one of them means nothing.
struct Measured {
  double ms = 0;
  double psnr_db = 0;
};

/// The range of every setting, from the measured star, each compared with the defaults (the first).
std::vector<SettingRange> setting_ranges(std::span<const Configuration> star,
                                         std::span<const Measured> measured, std::size_t settings);

struct FactorialLimits {
  std::size_t max_settings = 4;
  std::size_t max_configurations = 64;
};

/// All combinations of the settings that matter that the star does not have: at most
/// `max_settings`, those that move time and error most, by the product of both; where that leaves
/// more configurations than the limit that can be drawn, the last of these settings are put back.
Design factorial(std::span<const int> value_counts, std::span<const SettingRange> ranges,
                 const Refusal& refuse, const FactorialLimits& limits = {});

/// A sentence for each of `limits` that left settings out.
std::vector<std::string> describe(const Reduction& reduction, const FactorialLimits& limits);

}  // namespace tureen::tradeoff
