// Sums over the pairs of splats and tiles. Included once for each target of Highway.
#if defined(TUREEN_PAIR_SUMS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_PAIR_SUMS_INL
#undef TUREEN_PAIR_SUMS_INL
#else
#define TUREEN_PAIR_SUMS_INL
#endif

#include <span>

#include "splatting/vector_math-inl.hpp"
#include "trainer/splats/splat_memory.hpp"
#include "trainer/splats/tile_passes.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace shared {

using namespace splatting::HWY_NAMESPACE;

/// The moments of a vector of splats. `Moments` has only floats.
template <class Moments>
struct PairSums {
  Floats values[sizeof(Moments) / sizeof(float)];
  Mask drawn;  // whether the splats have pairs
};

/// Of the splats from `i` on. Adds the pairs of each splat in their order.
template <class Moments>
HWY_INLINE PairSums<Moments> pair_sums(std::span<const PairSpan> pairs,
                                       std::span<const Moments> moments, std::size_t i) {
  constexpr std::size_t values = sizeof(Moments) / sizeof(float);
  alignas(64) float sums[values][lanes] = {};
  alignas(64) float drawn[lanes] = {};
  const auto* floats = reinterpret_cast<const float*>(moments.data());
  for (std::size_t lane = 0; lane < lanes && i + lane < pairs.size(); ++lane) {
    const PairSpan range = pairs[i + lane];
    if (range.begin == range.end) continue;
    drawn[lane] = 1;
    float total[values] = {};
    for (std::uint32_t pair = range.begin; pair < range.end; ++pair)
      for (std::size_t k = 0; k < values; ++k) total[k] += floats[values * pair + k];
    for (std::size_t k = 0; k < values; ++k) sums[k][lane] = total[k];
  }
  PairSums<Moments> result;
  for (std::size_t k = 0; k < values; ++k) result.values[k] = hn::Load(d, sums[k]);
  result.drawn = hn::Gt(hn::Load(d, drawn), hn::Zero(d));
  return result;
}

/// MomentsOfThree of a vector of splats.
struct SumsOfThree {
  Vector3 one, x, y, color;  // of q, q x and q y
  Floats h, others[2], evident;
  Mask drawn;
};

HWY_INLINE SumsOfThree sums_of_three(std::span<const PairSpan> pairs,
                                     std::span<const MomentsOfThree> moments, std::size_t i) {
  const auto [values, drawn] = pair_sums(pairs, moments, i);
  const auto& v = values;
  return {{v[0], v[1], v[2]},
          {v[4], v[5], v[6]},
          {v[8], v[9], v[10]},
          {v[3], v[7], v[11]},
          v[12],
          {v[13], v[14]},
          v[15],
          drawn};
}

}  // namespace shared
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
