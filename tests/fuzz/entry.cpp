// The entry points for libFuzzer. Built once for each target, TUREEN_FUZZ_TARGET.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "base/error.hpp"
#include "base/memory_budget.hpp"
#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  // More than a valid input of some kilobytes needs, and less than the limit in run.sh. So the
  // fuzzer finds readers that do not count their memory.
  tureen::set_max_memory(32 << 20);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    tureen::fuzz::TUREEN_FUZZ_TARGET(std::as_bytes(std::span(data, size)));
  } catch (const tureen::InputError& error) {
    if (error.reason().empty() || error.position().file.empty()) {
      std::fprintf(stderr, "an error without a place or a reason: '%s'\n", error.what());
      std::abort();
    }
  }
  return 0;
}
