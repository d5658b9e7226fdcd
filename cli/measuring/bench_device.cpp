#include "cli/measuring/bench_device.hpp"

#include "base/error.hpp"
#include "jobs/timing/benchmark.hpp"

namespace tureen::cli {

BenchDevice device_of(const gl::Context& context) {
  const gl::Capabilities& capabilities = context.capabilities();
  return {.context = context.description(),
          .renderer = capabilities.renderer,
          .vendor = capabilities.vendor,
          .version = capabilities.version,
          .software = capabilities.software};
}

BenchClock clock_for(const BenchDevice& device, bool processor_time) {
  if (!processor_time)
    return {"steady clock of the processor, from an idle device until it has finished", nullptr};
  if (!device.software)
    throw UsageError("--processor-time needs a software renderer, but " + device.renderer +
                     " is hardware");
  return {"processor time of all threads, not time that passed: for ratios on a busy machine",
          processor_seconds};
}

}  // namespace tureen::cli
