// A valid input of every kind for every target, made by the tests' writers: what damage begins with
// (tests/formats/hostile_test.cpp) and what fuzzers begin with (seeds.cpp).
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

/// Small, so that every length can be tried. Each is read without an error.
std::vector<Fixture> fixtures();

/// What a PNG of 8 or 16 bits says of itself. `rows` is deflated as it is, whatever the size.
struct PngFixture {
  std::uint32_t width = 1, height = 1;
  std::uint8_t depth = 8, color_type = 6, interlace = 0;
  std::string rows;

  std::vector<std::byte> bytes() const;
};

}  // namespace tureen::fuzz
