// A valid input of every kind for every target, by the tests' writers. Damage
// (tests/formats/hostile_test.cpp) and fuzzers (seeds.cpp) start from them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tureen::fuzz {

struct Fixture {
  std::string target;  // of fuzz/targets.hpp
  std::string name;
  std::vector<std::byte> bytes;
};

/// Small inputs, so that tests can try every length. Each is readable without an error. They are
/// made once, by the first call.
const std::vector<Fixture>& fixtures();

/// A PNG of 8 or 16 bits with this header. `rows` is deflated unchanged, at any size.
struct PngFixture {
  std::uint32_t width = 1, height = 1;
  std::uint8_t depth = 8, color_type = 6, interlace = 0;
  std::string rows;

  std::vector<std::byte> bytes() const;
};

}  // namespace tureen::fuzz
