// Which configurations to measure: one knob at a time around the defaults (the star), then all
// combinations of the few knobs that turned out to matter (the full factorial). Knows knobs by
// their numbers alone; what they mean is runtime/tradeoff/knobs.hpp.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tureen::tradeoff {

/// The setting of each knob, by its number; 0 is the default.
using Configuration = std::vector<int>;

/// How many knobs are not at their default.
int departures(const Configuration& configuration);

/// Why a configuration cannot be drawn; nothing where it can.
using Refusal = std::function<std::optional<std::string>(const Configuration&)>;

struct Skipped {
  Configuration configuration;
  std::string reason;
};

/// What the limits of factorial() left of the knobs that matter.
struct Reduction {
  std::size_t mattering = 0;       // knobs
  std::size_t wanted = 0;          // of those, within FactorialLimits::most_knobs
  std::size_t configurations = 0;  // all combinations of the wanted knobs that can be drawn
  std::size_t combined = 0;        // knobs left within FactorialLimits::most_configurations
};

struct Design {
  std::vector<Configuration> configurations;
  /// What cannot be drawn; of several of which one is part of the others, that one alone.
  std::vector<Skipped> skipped;
  Reduction reduction = {};
};

/// The defaults, then every other setting of every knob alone. `settings` is how many each knob
/// has, at least 1. The defaults themselves must not be refused.
Design star(std::span<const int> settings, const Refusal& refuse);

/// What turning one knob through its settings did.
struct KnobRange {
  std::size_t knob = 0;
  double time_ratio = 1;  // the slowest over the fastest
  double psnr_db = 0;     // the best minus the worst

  /// More than 5 % of time and more than 0.5 dB: a knob that moves one alone is no compromise, and
  /// is set without an experiment.
  bool matters() const { return time_ratio > 1.05 && psnr_db > 0.5; }
};

/// Time and error of a configuration of the star; NaN where one of them means nothing.
struct Measured {
  double ms = 0;
  double psnr_db = 0;
};

/// The range of every knob, from the measured star, each compared with the defaults (the first).
std::vector<KnobRange> knob_ranges(std::span<const Configuration> star,
                                   std::span<const Measured> measured, std::size_t knobs);

struct FactorialLimits {
  std::size_t most_knobs = 4;
  std::size_t most_configurations = 64;
};

/// All combinations of the knobs that matter that the star does not have: at most `most_knobs`,
/// those that move time and error most, by the product of both; where that leaves more
/// configurations than the limit that can be drawn, the last of these knobs are put back.
Design factorial(std::span<const int> settings, std::span<const KnobRange> ranges,
                 const Refusal& refuse, const FactorialLimits& limits = {});

/// A sentence for each of `limits` that left knobs out.
std::vector<std::string> describe(const Reduction& reduction, const FactorialLimits& limits);

}  // namespace tureen::tradeoff
