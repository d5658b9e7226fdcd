// Fuzz targets: every reader as a function of bytes (listed in targets.def). Fuzzers, the replay of
// their corpora and tests/formats/hostile_test.cpp call the same functions.
#pragma once

#include <cstddef>
#include <span>

namespace tureen::fuzz {

using Bytes = std::span<const std::byte>;

// Each reads the bytes, or throws InputError. Any other outcome is a fault: another exception, a
// scene with a defect, a crash.
#define TARGET(name) void name(Bytes bytes);
#include "tests/fuzz/targets.def"
#undef TARGET

struct Target {
  const char* name;
  void (*read)(Bytes);
};

inline constexpr Target targets[] = {
#define TARGET(name) {#name, name},
#include "tests/fuzz/targets.def"
#undef TARGET
};

}  // namespace tureen::fuzz
