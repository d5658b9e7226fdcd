// Random numbers that are the same on every platform, unlike the standard library's distributions,
// and value noise for grain, pores and glaze.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace tureen::example {

/// Mixes 64 bits so that every input bit affects every output bit (the finaliser of splitmix64).
constexpr std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// splitmix64: mixed() of a counter.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() { return mixed(state_ += 0x9e3779b97f4a7c15ull); }
  /// In [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

 private:
  std::uint64_t state_;
};

/// Smooth, in [0, 1], with features about one unit wide.
inline double value_noise(glm::dvec2 p, std::uint64_t seed) {
  const glm::dvec2 cell = glm::floor(p);
  const glm::dvec2 f = p - cell;
  const auto corner = [&](double x, double y) {
    const auto ix = static_cast<std::uint64_t>(static_cast<std::int64_t>(x));
    const auto iy = static_cast<std::uint64_t>(static_cast<std::int64_t>(y));
    return static_cast<double>(mixed(mixed(mixed(seed) + ix) + iy) >> 11) * 0x1p-53;
  };
  const glm::dvec2 w = f * f * (3.0 - 2.0 * f);
  return glm::mix(glm::mix(corner(cell.x, cell.y), corner(cell.x + 1, cell.y), w.x),
                  glm::mix(corner(cell.x, cell.y + 1), corner(cell.x + 1, cell.y + 1), w.x), w.y);
}

/// Octaves of value noise, in [0, 1]. Each has twice the frequency and half the weight of the one
/// before.
inline double fractal_noise(glm::dvec2 p, int octaves, std::uint64_t seed) {
  double sum = 0, weight = 0.5, total = 0;
  for (int i = 0; i < octaves; ++i, p = 2.0 * p, weight *= 0.5) {
    sum += weight * value_noise(p, seed + i);
    total += weight;
  }
  return sum / total;
}

}  // namespace tureen::example
