#include "splatting/gaussians/gaussian_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "splatting/ellipse.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splatting/gaussians/gaussian_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/gaussians/gaussian_alpha-inl.hpp"
#include "splatting/harmonics-inl.hpp"
#include "splatting/rotation-inl.hpp"
#include "splatting/tiles/blending-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// The members of GaussianEntry, in their order, and the depth.
namespace entry_member {
enum : std::size_t {
  x,
  y,
  p,
  q,
  r,
  log_opacity,
  red,
  green,
  blue,
  inverse_depth,
  limit,
  half_width,
  half_height,
  depth,  // of the centre; NaN: not drawn
  count
};
}

/// A vector of projected splats, member by member.
struct ProjectedVector {
  alignas(64) float values[entry_member::count][lanes];

  HWY_INLINE void write(std::span<GaussianEntry> entries, std::span<float> depths) const {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const auto of = [&](std::size_t k) { return values[k][i]; };
      entries[i] = {of(0), of(1), of(2), of(3),  of(4),  of(5), of(6),
                    of(7), of(8), of(9), of(10), of(11), of(12)};
    }
    std::copy_n(values[entry_member::depth], depths.size(), depths.data());
  }
};

void project_gaussians_on(const ImageView& view, const ParameterRows& gaussians, int degree,
                          std::size_t begin, std::size_t end, ProjectedGaussians& projected) {
  namespace in = gaussian_row;
  namespace out = entry_member;
  const Floats min_log_alpha = constant(std::log2(view.min_alpha));
  const Floats zero = hn::Zero(d), one = constant(1.0f);
  const std::span<GaussianEntry> entries = projected.entries;
  const std::span<float> depths = projected.depth;
  for (std::size_t i = begin; i < end; i += lanes) {
    ProjectedVector result;
    const auto load = [&](std::size_t row) { return hn::Load(d, gaussians.row(row) + i); };
    const auto store = [&](std::size_t member, Floats value) {
      hn::Store(value, d, result.values[member]);
    };
    const Vector3 offset = from_eye(view, {load(in::x), load(in::y), load(in::z)});
    const Vector3 center = product(view.view_from_layer, offset);
    Mask drawn = hn::Gt(center.z, constant(std::fmax(view.near, view.min_center_depth)));
    const Floats depth = hn::IfThenElse(drawn, center.z, one);

    // Rows of the Jacobian times the scaled axes: a 2 x 3 matrix M, with covariance M M^T. Beyond
    // 1e18 pixels the squares below overflow.
    const Rotation rotation = rotation_of(load(in::rotation_x), load(in::rotation_y),
                                          load(in::rotation_z), load(in::rotation_w));
    const Floats largest = hn::Mul(constant(1e18f / std::fmax(view.fx, view.fy)), depth);
    const auto clamped = [&](Floats value, int axis) {
      return hn::Clamp(value, constant(view.slope_low[axis]), constant(view.slope_high[axis]));
    };
    const Floats inverse_depth = hn::Div(one, depth);
    const Floats slope_x = hn::Mul(center.x, inverse_depth),
                 slope_y = hn::Mul(center.y, inverse_depth);
    const Floats along_x = clamped(slope_x, 0), along_y = clamped(slope_y, 1);
    const Floats focal_x = hn::Mul(constant(view.fx), inverse_depth),
                 focal_y = hn::Mul(constant(view.fy), inverse_depth);
    Floats x[3], y[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 axis = product(view.view_from_layer, rotation.axes[k]);
      const Floats scale = hn::Min(load(in::scale_x + k), largest);
      x[k] = hn::Mul(hn::Mul(hn::NegMulAdd(along_x, axis.z, axis.x), scale), focal_x);
      y[k] = hn::Mul(hn::Mul(hn::NegMulAdd(along_y, axis.z, axis.y), scale), focal_y);
    }
    // The fourth powers below overflow beyond 1e9 pixels, which centres near the eye's plane reach
    // (docs/numerics.md, E2): large Gaussians are measured in another unit.
    const Floats size = hn::Sqrt(hn::Max(dot({x[0], x[1], x[2]}, {x[0], x[1], x[2]}),
                                         dot({y[0], y[1], y[2]}, {y[0], y[1], y[2]})));
    const Floats unit_size = hn::IfThenElse(hn::Gt(size, constant(1e7f)), size, one);
    const Floats by_unit = hn::Div(one, unit_size);
    const auto in_units = [&](const Floats(&row)[3]) {
      return Vector3{hn::Mul(row[0], by_unit), hn::Mul(row[1], by_unit), hn::Mul(row[2], by_unit)};
    };
    const Vector3 row_x = in_units(x), row_y = in_units(y);
    Floats xx = dot(row_x, row_x), yy = dot(row_y, row_y);
    const Floats xy = dot(row_x, row_y);
    // The determinant as a cross product: xx yy - xy^2 cancels for needles (docs/numerics.md, E1).
    const Vector3 normal = cross(row_x, row_y);
    Floats determinant = dot(normal, normal);
    Floats opacity = load(in::opacity);
    if (view.dilation > 0) {
      const Floats dilation = hn::Mul(hn::Mul(constant(view.dilation), by_unit), by_unit),
                   before = determinant;
      determinant = hn::MulAdd(dilation, hn::Add(hn::Add(xx, yy), dilation), determinant);
      xx = hn::Add(xx, dilation);
      yy = hn::Add(yy, dilation);
      if (view.keep_integral) opacity = hn::Mul(opacity, hn::Sqrt(hn::Div(before, determinant)));
    }
    drawn = hn::And(drawn, hn::Gt(opacity, zero));
    const Floats log_opacity = log2_of(hn::IfThenElse(drawn, opacity, one));
    const Floats excess = hn::Sub(log_opacity, min_log_alpha);
    // Comparisons that are false for NaN.
    drawn = hn::And(drawn, hn::Gt(excess, zero));
    drawn = hn::And(drawn, hn::Gt(determinant, zero));

    // The Cholesky factor of the inverse covariance: (p dx + q dy)^2 + (r dy)^2.
    const Floats factor = constant(exponent_factor);
    const Floats root_y = hn::Sqrt(yy), inverse_y = hn::Div(one, root_y);
    const Floats inverse_area = hn::Div(factor, hn::Sqrt(determinant));
    store(out::x, hn::MulAdd(constant(view.fx), slope_x, constant(view.cx)));
    store(out::y, hn::MulAdd(constant(view.fy), slope_y, constant(view.cy)));
    store(out::p, hn::Mul(hn::Mul(root_y, inverse_area), by_unit));
    store(out::q, hn::Neg(hn::Mul(hn::Mul(hn::Mul(xy, inverse_y), inverse_area), by_unit)));
    store(out::r, hn::Mul(hn::Mul(factor, inverse_y), by_unit));
    store(out::log_opacity, log_opacity);
    store(out::inverse_depth, inverse_depth);
    store(out::limit, excess);
    store(out::depth, hn::IfThenElse(drawn, center.z, not_drawn()));
    const Floats radius = hn::Mul(hn::Div(hn::Sqrt(hn::Max(excess, zero)), factor), unit_size);
    store(out::half_width, hn::Mul(radius, hn::Sqrt(xx)));
    store(out::half_height, hn::Mul(radius, root_y));

    const Vector3 color =
        harmonics_color(degree, offset, gaussians.row(in::harmonics), gaussians.stride(), i);
    store(out::red, color.x);
    store(out::green, color.y);
    store(out::blue, color.z);
    const std::size_t splats = std::min(lanes, end - i);
    result.write(entries.subspan(i, splats), depths.subspan(i, splats));
  }
}

struct GaussianLoops {
  using Entry = GaussianEntry;
  using ColorOf = OneColor;
  static HWY_INLINE GaussianAlpha alpha_of(const ImageView& view) {
    return {constant(std::log2(view.min_alpha))};
  }
  static HWY_INLINE auto depth_of(const ImageView& view, const ParameterRows& gaussians,
                                  std::span<const std::uint32_t> order) {
    return [&view, &gaussians, order](std::uint32_t place) {
      return GaussianPeakDepth{view, gaussian_peak(view, gaussians, order[place])};
    };
  }
};

const KernelFunctions<GaussianKernel>& gaussian_functions() {
  static constexpr KernelFunctions<GaussianKernel> functions{
      &project_gaussians_on, &blend_on<GaussianLoops>, &collect_on<GaussianLoops>};
  return functions;
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::splatting {

HWY_EXPORT(gaussian_functions);

const KernelFunctions<GaussianKernel>& GaussianKernel::functions() {
  return HWY_DYNAMIC_DISPATCH(gaussian_functions)();
}

void GaussianKernel::list(const Entry& entry, const Outline&, std::uint32_t splat,
                          TileLists& lists) {
  list_ellipse({.x = entry.x,
                .y = entry.y,
                .p = entry.p,
                .q = entry.q,
                .r = entry.r,
                .limit = entry.limit,
                .half_width = entry.half_width,
                .half_height = entry.half_height},
               splat, lists);
}

GaussianPeak gaussian_peak(const ImageView& view, const ParameterRows& gaussians, std::size_t i) {
  namespace row = gaussian_row;
  const auto value = [&](std::size_t which) { return gaussians.row(which)[i]; };
  const float* m = view.view_from_layer;
  const auto in_view = [&](const glm::vec3& v, int axis) {
    return m[3 * axis] * v.x + m[3 * axis + 1] * v.y + m[3 * axis + 2] * v.z;
  };
  const glm::vec3 scales(value(row::scale_x), value(row::scale_y), value(row::scale_z));
  const float smallest = std::min(scales.x, std::min(scales.y, scales.z));
  const glm::mat3 rotation =
      glm::mat3_cast(glm::normalize(glm::quat(value(row::rotation_w), value(row::rotation_x),
                                              value(row::rotation_y), value(row::rotation_z))));
  glm::vec3 from_eye;
  for (int axis = 0; axis < 3; ++axis)
    from_eye[axis] = (value(row::x + std::size_t(axis)) - view.eye_high[axis]) - view.eye_low[axis];
  GaussianPeak peak;
  for (int axis = 0; axis < 3; ++axis) {
    peak.center[axis] = in_view(from_eye, axis);
    for (int k = 0; k < 3; ++k)
      peak.axes[3 * k + axis] =
          (scales[k] > 0 ? smallest / scales[k] : 1.0f) * in_view(rotation[k], axis);
  }
  return peak;
}

}  // namespace tureen::splatting
#endif
