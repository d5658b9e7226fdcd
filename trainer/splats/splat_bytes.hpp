// How many splats, with harmonics of which degree, fit in a number of bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "trainer/splats/parameter_kinds.hpp"

namespace tureen::trainer {

/// Bytes of a splat's values as single floats, as files without compression store them.
template <class Parameters>
std::size_t bytes_of_splat(int degree) {
  return sizeof(float) * Parameters(0, degree).rows();
}

struct SplatsInBytes {
  int degree = 0;
  std::uint64_t splats = 0;
};

/// The highest degree with which at least Parameters::least_of_degree splats fit in `bytes`, and
/// that number of splats; 0 splats: not even one fits. Few splats gain more by their number than by
/// colours that depend on the direction.
template <class Parameters>
SplatsInBytes splats_in_bytes(std::uint64_t bytes) {
  for (int degree = int(Parameters::least_of_degree.size()) - 1; degree > 0; --degree)
    if (const std::uint64_t splats = bytes / bytes_of_splat<Parameters>(degree);
        splats >= Parameters::least_of_degree[std::size_t(degree)])
      return {degree, splats};
  return {0, bytes / bytes_of_splat<Parameters>(0)};
}

}  // namespace tureen::trainer
