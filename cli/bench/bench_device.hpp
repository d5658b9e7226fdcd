// What `tureen bench` and `tureen tradeoff` measure on, and by which clock.
#pragma once

#include <functional>
#include <string>

#include "jobs/results/bench_json.hpp"
#include "runtime/gl/context.hpp"

namespace tureen::cli {

BenchDevice device_of(const gl::Context& context);

struct BenchClock {
  std::string text;             // for people: "steady clock of the processor, .."
  std::function<double()> now;  // seconds; empty: the steady clock
};

/// The steady clock, or with --processor-time that of all threads of this program. Throws
/// UsageError where the device is no software renderer: its work is not the processor's.
BenchClock clock_for(const BenchDevice& device, bool processor_time);

}  // namespace tureen::cli
