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

}  // namespace shared
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
