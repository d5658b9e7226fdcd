// The alpha of projected windows. Included once for each target of Highway.
#if defined(TUREEN_WINDOW_ALPHA_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_WINDOW_ALPHA_INL
#undef TUREEN_WINDOW_ALPHA_INL
#else
#define TUREEN_WINDOW_ALPHA_INL
#endif

#include "splatting/tiles/blending-inl.hpp"
#include "splatting/vector_math-inl.hpp"
#include "splatting/windows/window_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// A window at image points. rho is the smallest of the distances from the edges over the inradius.
struct WindowAt {
  Floats distance[3], rho, dx, dy;  // dx, dy: from the image of the centre

  HWY_INLINE WindowAt(const WindowShape& entry, Floats x, Floats y)
      : dx(hn::Sub(x, constant(entry.x))), dy(hn::Sub(y, constant(entry.y))) {
    for (std::size_t k = 0; k < 3; ++k) distance[k] = linear(entry.edges + 3 * k);
    rho = hn::Min(hn::Min(distance[0], distance[1]), distance[2]);
  }

  HWY_INLINE Floats linear(const float* factors) const {
    return hn::MulAdd(constant(factors[0]), dx,
                      hn::MulAdd(constant(factors[1]), dy, constant(factors[2])));
  }
};

/// The logarithm to the base 2 of rho, but at most 0, where rho > 0. log2_of() needs normal
/// numbers, also where the window is not drawn.
HWY_INLINE Floats log_rho_of(Floats rho) {
  return log2_of(hn::Min(hn::Max(rho, constant(1e-30f)), constant(1.0f)));
}

/// alpha before it is limited to the largest. -126 is the smallest argument of exp2_of().
HWY_INLINE Floats window_alpha_of(const WindowShape& entry, Floats log_rho) {
  const Floats log_alpha = hn::MulAdd(constant(entry.sigma), log_rho, constant(entry.log_opacity));
  return exp2_of(hn::Max(log_alpha, constant(-126.0f)));
}

/// `alpha_of` of blend_entries().
struct WindowAlpha {
  Floats inverse_near;

  /// By the largest distance from each edge in each block.
  HWY_INLINE unsigned blocks(const WindowShape& entry, const BlockCorners& corners) const {
    const auto set = [](float value) { return hn::Set(of_blocks, value); };
    const Blocks dx = hn::Sub(corners.x, set(entry.x)), dy = hn::Sub(corners.y, set(entry.y));
    const auto largest = [&](const float* edge) {
      const Blocks at = hn::MulAdd(set(edge[0]), dx, hn::MulAdd(set(edge[1]), dy, set(edge[2])));
      return largest_in_block(at, edge[0], edge[1]);
    };
    const float* edges = entry.edges;
    const Blocks rho = hn::Min(hn::Min(largest(edges), largest(edges + 3)), largest(edges + 6));
    return bits_of(of_blocks, hn::Ge(rho, set(entry.min_rho)));
  }

  /// Returns the pixels where alpha reaches the smallest value, and sets `alpha` there.
  HWY_INLINE Mask operator()(const WindowShape& entry, Floats x, Floats y, Floats inverse_behind,
                             Floats& alpha) const {
    const WindowAt at(entry, x, y);
    Mask covered = hn::Ge(at.rho, constant(entry.min_rho));
    if (none(covered)) return covered;
    const Floats inverse_depth = at.linear(entry.inverse_depth);
    covered = hn::And(covered, hn::Gt(inverse_depth, inverse_behind));
    covered = hn::And(covered, hn::Lt(inverse_depth, inverse_near));
    alpha = window_alpha_of(entry, log_rho_of(at.rho));
    return covered;
  }
};

/// The depth of a window's plane along rays.
struct WindowDepth {
  HWY_INLINE Floats operator()(const WindowShape& entry, Floats x, Floats y, Floats) const {
    return hn::Div(constant(1.0f), WindowAt(entry, x, y).linear(entry.inverse_depth));
  }
};

/// The loops of blend_on() and collect_on().
struct WindowLoops {
  using Entry = WindowEntry;
  using ColorOf = OneColor;
  static HWY_INLINE WindowAlpha alpha_of(const ImageView& view) {
    return {constant(1.0f / view.near)};
  }
  static HWY_INLINE auto depth_of(const ImageView&, const ParameterRows&,
                                  std::span<const std::uint32_t>) {
    return [](std::uint32_t) { return WindowDepth(); };
  }
};

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
