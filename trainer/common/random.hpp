// Random numbers that are the same on every machine: SplitMix64 (Steele, Lea, Flood: Fast
// splittable pseudorandom number generators, 2014). The distributions use only arithmetic that
// IEEE 754 defines exactly; the standard distributions differ between libraries.
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <numeric>
#include <utility>
#include <vector>

namespace tureen::trainer {

class Random {
 public:
  /// Streams of one seed are independent of each other; each purpose has its own stream.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0)
      : state_(mix(seed) + mix(~stream)) {}

  std::uint64_t bits() { return mix(state_ += 0x9e3779b97f4a7c15u); }
  /// [0, 1), in steps of 2^-53.
  double uniform() { return double(bits() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in 0 .. count - 1, for count > 0. The bias is below count / 2^53.
  std::uint64_t below(std::uint64_t count) {
    assert(count > 0);
    return std::uint64_t(uniform() * double(count));
  }
  /// Uniform in the unit ball, by rejection.
  glm::dvec3 in_ball();
  /// Uniform in SO(3): a unit quaternion from two points in a disc (Marsaglia 1972).
  glm::dmat3 rotation();

 private:
  static std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

inline glm::dvec3 Random::in_ball() {
  for (;;) {
    const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
    if (x * x + y * y + z * z <= 1) return {x, y, z};
  }
}

inline glm::dmat3 Random::rotation() {
  double p[2][2], norm[2];
  for (int i = 0; i < 2; ++i) do {
      p[i][0] = uniform(-1, 1);
      p[i][1] = uniform(-1, 1);
      norm[i] = p[i][0] * p[i][0] + p[i][1] * p[i][1];
    } while (norm[i] > 1 || norm[i] == 0);
  const double scale = std::sqrt((1 - norm[0]) / norm[1]);
  const double w = p[0][0], x = p[0][1], y = p[1][0] * scale, z = p[1][1] * scale;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

/// `count` different numbers (at most all) from 0 .. of - 1 in random order: the first steps of
/// the Fisher-Yates shuffle.
inline std::vector<std::uint32_t> draw(Random& random, std::size_t count, std::size_t of) {
  std::vector<std::uint32_t> all(of);
  std::iota(all.begin(), all.end(), 0u);
  count = std::min(count, of);
  for (std::size_t i = 0; i < count; ++i) std::swap(all[i], all[i + random.below(of - i)]);
  all.resize(count);
  return all;
}

}  // namespace tureen::trainer
