// The configurations of an experiment: one setting at a time around the defaults (the star), then
// all combinations of the few settings that matter (the full factorial). Settings are numbers here;
// their meaning is in jobs/tradeoff/quality_settings.hpp.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tureen::tradeoff {

/// The value index of each setting; 0 is the default.
using Configuration = std::vector<int>;

/// Number of settings that differ from their default.
int departures(const Configuration& configuration);

/// The reason why a configuration cannot be drawn, or nullopt.
using Refusal = std::function<std::optional<std::string>(const Configuration&)>;

struct Skipped {
  Configuration configuration;
  std::string reason;
};

/// The effect of the limits of factorial() on the settings that matter.
struct Reduction {
  std::size_t mattering = 0;       // number of settings that matter
  std::size_t wanted = 0;          // of these, at most FactorialLimits::max_settings
  std::size_t configurations = 0;  // drawable combinations of the wanted settings
  std::size_t combined = 0;        // settings kept within FactorialLimits::max_configurations
};

struct Design {
  std::vector<Configuration> configurations;
  /// Configurations that cannot be drawn. If one is part of others, only that one is listed.
  std::vector<Skipped> skipped;
  Reduction reduction = {};
};

/// The defaults, then every other value of every setting alone. `value_counts` is the number of
/// values of each setting, at least 1. The defaults must be drawable.
Design star(std::span<const int> value_counts, const Refusal& refuse);

/// The effect of one setting over its values.
struct SettingRange {
  std::size_t setting = 0;
  double time_ratio = 1;  // the slowest over the fastest
  double psnr_db = 0;     // the best minus the worst

  /// More than 5 % of time and more than 0.5 dB. A setting that affects only one of them is no
  /// trade-off and needs no experiment.
  bool matters() const { return time_ratio > 1.05 && psnr_db > 0.5; }
};

/// Time and error of a configuration in the star; NaN if meaningless.
struct Measured {
  double ms = 0;
  double psnr_db = 0;
};

/// The range of every setting in the measured star, relative to the defaults, which come first.
std::vector<SettingRange> setting_ranges(std::span<const Configuration> star,
                                         std::span<const Measured> measured, std::size_t settings);

struct FactorialLimits {
  std::size_t max_settings = 4;
  std::size_t max_configurations = 64;
};

/// All combinations of the settings that matter, except those in the star. Uses at most
/// `max_settings` settings, ranked by the product of their effects on time and error. If more
/// drawable configurations remain than `max_configurations`, the lowest-ranked settings are
/// dropped.
Design factorial(std::span<const int> value_counts, std::span<const SettingRange> ranges,
                 const Refusal& refuse, const FactorialLimits& limits = {});

/// One sentence for each limit that dropped settings.
std::vector<std::string> describe(const Reduction& reduction, const FactorialLimits& limits);

}  // namespace tureen::tradeoff
