#include "scene/edit/lattice_refine.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "scene/lattice.hpp"

namespace tureen {

void refine_lattice(int from, int to, int channels, std::span<const float> coarse,
                    std::span<float> fine) {
  assert(from <= to && to <= lattice::max_level);
  assert(coarse.size() == std::size_t(lattice::texel_count(from)) * channels);
  assert(fine.size() == std::size_t(lattice::texel_count(to)) * channels);
  if (from == to) {
    std::copy(coarse.begin(), coarse.end(), fine.begin());
    return;
  }
  const double step = 1.0 / lattice::resolution(to);  // a power of two: barycentrics are exact
  for (std::uint32_t texel = 0; texel < lattice::texel_count(to); ++texel) {
    const auto [x, y] = lattice::texel_coordinates(texel);
    const auto at = lattice::footprint(from, x * step, y * step);
    for (int c = 0; c < channels; ++c) {
      double sum = 0;
      for (int k = 0; k < 3; ++k)
        sum += at.weights[k] * double(coarse[std::size_t(at.texels[k]) * channels + c]);
      fine[std::size_t(texel) * channels + c] = static_cast<float>(sum);
    }
  }
}

int highest_level(const LatticeTexture& texture) {
  std::uint32_t highest = 0;
  for (const LatticePatch& patch : texture.patches) highest = std::max(highest, patch.level);
  return static_cast<int>(highest);
}

}  // namespace tureen
