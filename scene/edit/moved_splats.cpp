#include "scene/edit/moved_splats.hpp"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <span>
#include <type_traits>

#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

/// Coefficients of the same function on the sphere after an orthogonal map of its directions.
class HarmonicsMap {
 public:
  HarmonicsMap(const glm::dmat3& map, int degree)
      : degree_(degree), count_(std::size_t(harmonics::count(degree))) {
    // Y_m(map^-1 d) = sum_n to_[m][n] Y_n(d), where to_[m][n] is the integral of the product of
    // Y_m(map^-1 d) and Y_n(d). Gauss and Legendre's five points in z and ten equal angles about it
    // are exact for polynomials up to degree 9; the products have at most degree 8.
    constexpr std::array<double, 5> z{-0.9061798459386640, -0.5384693101056831, 0,
                                      0.5384693101056831, 0.9061798459386640};
    constexpr std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665,
                                           0.5688888888888889, 0.4786286704993665,
                                           0.2369268850561891};
    constexpr int angles = 10;
    for (std::size_t i = 0; i < z.size(); ++i)
      for (int j = 0; j < angles; ++j) {
        const double angle = 2 * std::numbers::pi * j / angles, radius = std::sqrt(1 - z[i] * z[i]);
        const glm::dvec3 direction(radius * std::cos(angle), radius * std::sin(angle), z[i]);
        const auto after = harmonics::basis(direction);
        const auto before = harmonics::basis(glm::transpose(map) * direction);
        const double area = 2 * std::numbers::pi / angles * weight[i];
        for (std::size_t m = 0; m < count_; ++m)
          for (std::size_t n = 0; n < count_; ++n) to_[m][n] += area * before[m] * after[n];
      }
  }

  /// `coefficients`: harmonics::count(degree) of them.
  void apply(std::span<glm::vec3> coefficients) const {
    std::array<glm::dvec3, 25> sums{};
    // Maps keep the bands apart.
    for (std::size_t band = 1; band <= std::size_t(degree_); ++band)
      for (std::size_t m = band * band; m < (band + 1) * (band + 1); ++m)
        for (std::size_t n = band * band; n < (band + 1) * (band + 1); ++n)
          sums[n] += to_[m][n] * glm::dvec3(coefficients[m]);
    for (std::size_t n = 1; n < count_; ++n) coefficients[n] = glm::vec3(sums[n]);
  }

 private:
  int degree_;
  std::size_t count_;
  std::array<std::array<double, 25>, 25> to_{};
};

}  // namespace

void move_splats(Splats& splats, const glm::dmat4& place) {
  const glm::dmat3 linear(place);
  const double scale = std::cbrt(std::abs(glm::determinant(linear)));
  const glm::dmat3 turn = linear / scale;
  // An ellipsoid equals its image in its centre, so a mirror acts on it as the rotation -turn.
  const glm::dquat rotation = glm::quat_cast(glm::determinant(turn) < 0 ? -turn : turn);
  for_each_column(splats.kernel, [&](const auto& column) {
    for (auto& value : column.values)
      if constexpr (std::is_same_v<decltype(value), glm::quat&>)
        value = glm::quat(glm::normalize(rotation * glm::dquat(value)));
      else if constexpr (std::is_same_v<decltype(value), glm::vec3&>) {
        if (column.role == ColumnRole::scale)
          value = glm::vec3(scale * glm::dvec3(value));
        else
          value = glm::vec3(place * glm::dvec4(glm::dvec3(value), 1));
      } else if (column.role == ColumnRole::scale)
        value = float(scale * double(value));
  });
  std::visit([&](auto& kernel) { turn_values(kernel, turn); }, splats.kernel);
  splats.profile.min_center_depth *= float(scale);
  if (splats.color.degree == 0) return;
  const HarmonicsMap map(turn, splats.color.degree);
  const auto each = std::size_t(harmonics::count(splats.color.degree));
  std::span<glm::vec3> rest(splats.color.coefficients);
  for (; rest.size() >= each; rest = rest.subspan(each)) map.apply(rest.first(each));
}

}  // namespace tureen
