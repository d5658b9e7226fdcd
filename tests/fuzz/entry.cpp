// What libFuzzer calls. Built once a target, which TUREEN_FUZZ_TARGET names.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "base/error.hpp"
#include "base/memory_budget.hpp"
#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  // Far beyond what a valid input of some kilobytes takes, and far below what run.sh allows: who
  // does not count is found out.
  tureen::set_max_memory(32 << 20);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    tureen::fuzz::TUREEN_FUZZ_TARGET(std::as_bytes(std::span(data, size)));
  } catch (const tureen::InputError& error) {
    if (error.reason().empty() || error.place().file.empty()) {
      std::fprintf(stderr, "an error without a place or a reason: '%s'\n", error.what());
      std::abort();
    }
  }
  return 0;
}
