#include "splatting/neural/neural_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splatting/neural/neural_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/harmonics-inl.hpp"
#include "splatting/image_sides-inl.hpp"
#include "splatting/neural/neural_alpha-inl.hpp"
#include "splatting/rotation-inl.hpp"
#include "splatting/tiles/blending-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// Ellipsoids {center + U x : |x| <= 1}, in view coordinates and any unit.
struct Ellipsoid {
  Vector3 center, axes[3];  // the columns of U

  /// A component of the axes.
  HWY_INLINE Vector3 row(Floats Vector3::*component) const {
    return {axes[0].*component, axes[1].*component, axes[2].*component};
  }
};

/// projected_neural_row::outline. The image of an ellipsoid in front of the eye is an ellipse. With
/// the rows a, b and w of U for homogeneous image points relative to the image of the centre, all
/// over the centre's depth, and n = 1 - w . w, it is the covariance
///   (a . a + (a . w)^2 / n) / n, and likewise for b, and a with b,
/// around -(a . w, b . w) / n: no term cancels. The determinant is (n |a x b|^2 + |w x (a x b)|^2)
/// / n^3.
HWY_INLINE void outline_of(const ImageView& view, const Ellipsoid& ellipsoid,
                           Floats (&outline)[7]) {
  const Floats one = constant(1.0f), zero = hn::Zero(d);
  const Vector3& center = ellipsoid.center;
  const Mask in_front = hn::Gt(center.z, zero);
  const Floats by_depth = hn::Div(one, hn::IfThenElse(in_front, center.z, one));
  const Floats slope_x = hn::Mul(center.x, by_depth), slope_y = hn::Mul(center.y, by_depth);
  const Vector3 w = product(ellipsoid.row(&Vector3::z), by_depth);
  const auto in_pixels = [&](const Vector3& row, Floats slope, float focal) {
    const Floats scale = hn::Mul(by_depth, constant(focal));
    return difference(product(row, scale), product(w, hn::Mul(slope, constant(focal))));
  };
  const Vector3 a = in_pixels(ellipsoid.row(&Vector3::x), slope_x, view.fx);
  const Vector3 b = in_pixels(ellipsoid.row(&Vector3::y), slope_y, view.fy);
  // Near the eye's plane the ellipse grows without limit, and its numbers would overflow: it is
  // used while the ellipsoid stays 1/200 of the centre's depth before that plane.
  const Floats n = hn::Sub(one, dot(w, w));
  Mask bounded = hn::And(in_front, hn::Gt(n, constant(0.01f)));
  const Floats by_n = hn::Div(one, n);
  const Floats a_w = dot(a, w), b_w = dot(b, w);
  const auto covariance = [&](const Vector3& p, const Vector3& q, Floats p_w, Floats q_w) {
    return hn::Mul(hn::MulAdd(hn::Mul(p_w, q_w), by_n, dot(p, q)), by_n);
  };
  Floats xx = covariance(a, a, a_w, a_w), yy = covariance(b, b, b_w, b_w);
  Floats xy = covariance(a, b, a_w, b_w);
  const Vector3 normal = cross(a, b), across = cross(w, normal);
  Floats determinant = hn::Mul(hn::MulAdd(n, dot(normal, normal), dot(across, across)),
                               hn::Mul(by_n, hn::Mul(by_n, by_n)));
  // Wider by at least 1/64 pixel, for rounding: by a factor, and by a variance.
  const Floats factor = constant(1 + 0x1p-10f), variance = constant(0.25f);
  xx = hn::Mul(xx, factor), yy = hn::Mul(yy, factor), xy = hn::Mul(xy, factor);
  determinant = hn::Mul(determinant, hn::Mul(factor, factor));
  determinant = hn::MulAdd(variance, hn::Add(hn::Add(xx, yy), variance), determinant);
  xx = hn::Add(xx, variance), yy = hn::Add(yy, variance);
  // False for infinity and NaN: 100 times below the largest float.
  bounded = hn::And(bounded, hn::Lt(determinant, constant(1e36f)));

  const auto store = [&](std::size_t i, Floats value) { outline[i] = value; };
  const Floats root_y = hn::Sqrt(yy), by_root_y = hn::Div(one, root_y);
  const Floats by_area = hn::Div(one, hn::Sqrt(determinant));
  const Floats x =
      hn::NegMulAdd(a_w, by_n, hn::MulAdd(constant(view.fx), slope_x, constant(view.cx)));
  const Floats y =
      hn::NegMulAdd(b_w, by_n, hn::MulAdd(constant(view.fy), slope_y, constant(view.cy)));
  store(0, hn::IfThenElse(bounded, x, constant(std::numeric_limits<float>::quiet_NaN())));
  store(1, y);
  store(2, hn::Mul(root_y, by_area));
  store(3, hn::Neg(hn::Mul(hn::Mul(xy, by_root_y), by_area)));
  store(4, by_root_y);
  store(5, hn::Sqrt(xx));
  store(6, root_y);
}

void project_densities_on(const ImageView& view, const ParameterRows& densities, int degree,
                          std::size_t begin, std::size_t end, NeuralKernel::Projected& projected) {
  namespace in = neural_row;
  namespace out = projected_neural_row;
  const Floats one = constant(1.0f);
  for (std::size_t i = begin; i < end; i += lanes) {
    const auto load = [&](std::size_t row) { return hn::Load(d, densities.row(row) + i); };
    const auto load_vector = [&](std::size_t row) {
      return Vector3{load(row), load(row + 1), load(row + 2)};
    };
    const auto store = [&](std::size_t row, Floats value) {
      hn::Store(value, d, projected.row(row) + i);
    };
    const auto store_vector = [&](std::size_t row, const Vector3& v) {
      store(row, v.x);
      store(row + 1, v.y);
      store(row + 2, v.z);
    };
    const Vector3 offset = from_eye(view, load_vector(in::center));
    const Vector3 center = product(view.view_from_layer, offset);
    const Vector3 semi_axes = load_vector(in::semi_axes);
    // Squares of lengths in this unit neither overflow nor underflow (docs/numerics.md, N10). The
    // constant is the smallest normal number.
    const Floats largest = hn::Max(semi_axes.x, hn::Max(semi_axes.y, semi_axes.z));
    const Floats by_unit = hn::Div(one, power_of_2_in(hn::Max(largest, constant(0x1p-126f))));
    const Vector3 scaled = product(semi_axes, by_unit);
    const Rotation rotation = rotation_of(load(in::rotation), load(in::rotation + 1),
                                          load(in::rotation + 2), load(in::rotation + 3));
    const Floats lengths[3] = {scaled.x, scaled.y, scaled.z};
    Ellipsoid ellipsoid{product(center, by_unit), {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 axis = product(view.view_from_layer, rotation.axes[k]);
      ellipsoid.axes[k] = product(axis, lengths[k]);
      store_vector(out::sphere_from_view + 3 * k, product(axis, hn::Div(one, lengths[k])));
    }
    store_vector(out::center, ellipsoid.center);
    store(out::by_unit, by_unit);
    const Floats near = hn::Mul(constant(view.near), by_unit);
    store(out::near, near);

    const Floats by_largest = hn::Div(one, hn::Mul(largest, by_unit));
    store(out::twice_by_largest, hn::Add(by_largest, by_largest));
    for (std::size_t k = 0; k < neurons; ++k) {
      const Vector3 frequency = product(view.view_from_layer, load_vector(in::frequencies + 3 * k));
      store(out::frequencies + k, hn::Mul(frequency.x, by_largest));
      store(out::frequencies + neurons + k, hn::Mul(frequency.y, by_largest));
      store(out::frequencies + 2 * neurons + k, hn::Mul(frequency.z, by_largest));
      store(out::phases + k, load(in::phases + k));
      store(out::amplitudes + k, load(in::amplitudes + k));
    }
    store(out::offset, load(in::offset));

    Floats outline[7];
    outline_of(view, ellipsoid, outline);
    for (std::size_t k = 0; k < 7; ++k) store(out::outline + k, outline[k]);
    // The largest dot product of a vector with its points.
    const auto largest_along = [&](const Vector3& normal) {
      const Vector3 extents{dot(normal, ellipsoid.axes[0]), dot(normal, ellipsoid.axes[1]),
                            dot(normal, ellipsoid.axes[2])};
      return hn::Add(dot(normal, ellipsoid.center), hn::Sqrt(dot(extents, extents)));
    };
    Mask drawn = hn::Gt(largest_along({hn::Zero(d), hn::Zero(d), one}), near);
    drawn = hn::And(drawn, reach_image(view, [&](const Vector3& normal) {
                      return largest_along({hn::Mul(normal.x, constant(view.fx)),
                                            hn::Mul(normal.y, constant(view.fy)), normal.z});
                    }));
    if (view.min_center_depth > 0)
      drawn = hn::And(drawn, hn::Gt(center.z, constant(view.min_center_depth)));
    store(out::depth, hn::IfThenElse(drawn, center.z, not_drawn()));
    store_vector(out::red, harmonics_color(degree, offset, densities.row(in::harmonics),
                                           densities.stride(), i));
  }
}

struct NeuralLoops {
  using Entry = NeuralEntry;
  using ColorOf = OneColor;
  static HWY_INLINE NeuralAlpha alpha_of(const ImageView& view) { return NeuralAlpha(view); }
  static HWY_INLINE auto depth_of(const ImageView& view, const ParameterRows&,
                                  std::span<const std::uint32_t>) {
    return [&view](std::uint32_t) { return NeuralDepth{NeuralAlpha(view)}; };
  }
};

const KernelFunctions<NeuralKernel>& neural_functions() {
  static constexpr KernelFunctions<NeuralKernel> functions{
      &project_densities_on, &blend_on<NeuralLoops>, &collect_on<NeuralLoops>};
  return functions;
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::splatting {

HWY_EXPORT(neural_functions);

const KernelFunctions<NeuralKernel>& NeuralKernel::functions() {
  return HWY_DYNAMIC_DISPATCH(neural_functions)();
}

void NeuralKernel::read(const Projected& projected, std::size_t i, Entry& entry, Outline& outline) {
  namespace row = projected_neural_row;
  const auto value = [&](std::size_t which) { return projected.row(which)[i]; };
  const auto read = [&](std::size_t first, auto& values) {
    for (std::size_t k = 0; k < std::size(values); ++k) values[k] = value(first + k);
  };
  read(row::center, entry.center);
  read(row::sphere_from_view, entry.sphere_from_view);
  entry.by_unit = value(row::by_unit);
  entry.near = value(row::near);
  entry.twice_by_largest = value(row::twice_by_largest);
  entry.offset = value(row::offset);
  read(row::frequencies, entry.frequencies);
  read(row::phases, entry.phases);
  read(row::amplitudes, entry.amplitudes);
  entry.red = value(row::red);
  entry.green = value(row::green);
  entry.blue = value(row::blue);
  float of_outline[7];
  read(row::outline, of_outline);
  const auto& [x, y, p, q, r, half_width, half_height] = of_outline;
  std::copy_n(of_outline, std::size(entry.outline), entry.outline);
  outline = {.x = x,
             .y = y,
             .p = p,
             .q = q,
             .r = r,
             .limit = 1,
             .half_width = half_width,
             .half_height = half_height};
}

void NeuralKernel::list(const Entry&, const Outline& outline, std::uint32_t splat,
                        TileLists& lists) {
  if (std::isnan(outline.x))
    lists.add_everywhere(splat);
  else
    list_ellipse(outline, splat, lists);
}

}  // namespace tureen::splatting
#endif
