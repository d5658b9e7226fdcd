// Random numbers that are the same with every standard library. The standard specifies
// std::mt19937_64 bit by bit, but not the distributions. (normal() and direction() call log and
// cos, whose last bit may differ between two C libraries.)
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <random>

namespace tureen::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform();                          // [0, 1)
  double uniform(double low, double high);   // [low, high)
  std::uint32_t below(std::uint32_t count);  // 0 .. count - 1
  bool chance(double probability);
  double normal();         // mean 0, deviation 1
  glm::dvec3 direction();  // uniform on the unit sphere

 private:
  std::mt19937_64 engine_;
};

}  // namespace tureen::test
