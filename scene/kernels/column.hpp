// What the files of the kernels share. A kernel is a struct of arrays. Its function
// for_each_column(kernel, act) lists them, and all code that treats the arrays alike (count, bytes,
// keep, reorder, move, files) loops over that list.
#pragma once

#include <concepts>
#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "scene/finite.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// `position` and `corner` are points, `scale` lengths along the local axes of `rotation`. A
/// rotation is its quaternion's x, y, z, w. Other data are `value`s. A `label` is carried along,
/// but no renderer reads it; its array may be empty.
enum class ColumnRole { position, corner, scale, rotation, opacity, value, label };

/// `unit_length` is for quaternions.
enum class ColumnRange { finite, positive, not_negative, fraction, unit_length };

/// One array of a kernel.
template <class Values>
struct Column {
  Values& values;
  const char* name;  // of one value, or of all those of a splat if they are of the role `value`
  std::size_t per_splat;  // number of values
  ColumnRole role;
  ColumnRange range;

  bool is_absent() const { return role == ColumnRole::label && values.empty(); }
  /// The values of splat `i`. They are only floats: glm::vec3 and glm::quat have no padding.
  std::span<const float> of_splat(std::size_t i) const {
    return {reinterpret_cast<const float*>(values.data() + per_splat * i),
            per_splat * sizeof(values[0]) / sizeof(float)};
  }
};

template <class Values>
Column(Values&, const char*, std::size_t, ColumnRole, ColumnRange) -> Column<Values>;

/// Calls act(name, value) for each number that all splats of a kernel share. The file of a kernel
/// with such numbers overloads it, and likewise turn_values().
void for_each_constant(auto& /*kernel*/, auto&& /*act*/) {}

/// Turns the values of a kernel that are vectors, as `turn`, orthogonal, turns the splats. The
/// columns of other roles are turned already.
void turn_values(auto& /*kernel*/, const glm::dmat3& /*turn*/) {}

/// The plural of a column's name: "scales", "opacities", "semi-axes".
std::string plural(std::string name);

template <class Type, class Plain>
concept MaybeConst = std::same_as<std::remove_const_t<Type>, Plain>;

/// A box around points; points that are not finite are ignored.
struct SplatBox {
  glm::vec3 low{std::numeric_limits<float>::max()};
  glm::vec3 high{std::numeric_limits<float>::lowest()};

  void add(const glm::vec3& point) {
    if (!is_finite(point)) return;
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  /// The ellipsoid with these semi-axes.
  void add(const glm::vec3& center, const glm::quat& rotation, const glm::dvec3& semi_axes);
  /// Zeros without points.
  Bounds bounds() const { return low.x <= high.x ? Bounds{low, high} : Bounds{}; }
};

/// The extents of a splat, in layer units.
struct SplatSize {
  double length = 0, width = 0;  // the largest, and the second largest
  bool has_zero = false;

  static SplatSize of_ellipsoid(const glm::dvec3& semi_axes);
};

/// The largest cross-section of an ellipsoid over pi, in double: it may exceed a float.
double largest_section(const glm::dvec3& semi_axes);

}  // namespace tureen
