// The device and the clock of `tureen bench` and `tureen tradeoff`.
#pragma once

#include <functional>
#include <string>

#include "jobs/bench/bench_json.hpp"
#include "runtime/gl/context.hpp"

namespace tureen::cli {

BenchDevice device_of(const gl::Context& context);

struct BenchClock {
  std::string text;             // description: "steady clock of the processor, .."
  std::function<double()> now;  // seconds; empty: the steady clock
};

/// The steady clock, or with --processor-time the CPU time of all threads. Throws UsageError
/// if that is requested for hardware, whose work takes no CPU time.
BenchClock clock_for(const BenchDevice& device, bool processor_time);

}  // namespace tureen::cli
