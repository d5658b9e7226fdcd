#include "tests/support/random_splats.hpp"

#include <cmath>
#include <glm/geometric.hpp>

#include "scene/spherical_harmonics.hpp"
#include "tests/support/random.hpp"

namespace tureen::test {

namespace {

glm::dvec3 point_in_ball(Random& random) {
  return std::cbrt(random.uniform()) * random.direction();
}

glm::quat random_rotation(Random& random) {
  glm::dquat q(random.normal(), random.normal(), random.normal(), random.normal());
  return glm::quat(glm::normalize(q));
}

/// A size that varies by a factor of about 3, and each axis by another.
glm::vec3 random_axes(Random& random, double size) {
  const double own = size * std::exp(0.5 * random.normal());
  return glm::vec3(own * glm::dvec3(std::exp(0.5 * random.normal()),
                                    std::exp(0.5 * random.normal()),
                                    std::exp(0.5 * random.normal())));
}

TriangleWindows windows(Random& random, std::size_t count, double size) {
  constexpr float sigmas[] = {0.1f, 1.16f, 3.0f};
  TriangleWindows result;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 center = point_in_ball(random);
    const double own = 2 * size * std::exp(0.5 * random.normal());
    for (int corner = 0; corner < 3; ++corner)
      result.corners.emplace_back(center + own * random.direction());
    result.sigma.push_back(sigmas[random.below(3)]);
    result.opacity.push_back(float(random.uniform(0.1, 1)));
  }
  return result;
}

Gaussians gaussians(Random& random, std::size_t count, double size, bool flat) {
  Gaussians result;
  result.flat = flat;
  for (std::size_t i = 0; i < count; ++i) {
    result.centers.emplace_back(point_in_ball(random));
    result.scales.push_back(random_axes(random, 0.5 * size));
    result.rotations.push_back(random_rotation(random));
    result.opacity.push_back(float(random.uniform(0.01, 1)));
  }
  return result;
}

NeuralDensities densities(Random& random, std::size_t count, double size) {
  NeuralDensities result;
  for (std::size_t i = 0; i < count; ++i) {
    result.centers.emplace_back(point_in_ball(random));
    result.semi_axes.push_back(random_axes(random, size));
    result.rotations.push_back(random_rotation(random));
    constexpr int width = NeuralDensities::width;
    for (int k = 0; k < 4 * width; ++k)
      result.networks.push_back(float(random.uniform(-1.0 / 3, 1.0 / 3)));
    for (int k = 0; k < width; ++k) result.networks.push_back(float(random.uniform(-0.3, 0.3)));
    result.networks.push_back(float(random.uniform(0, 1)));
  }
  return result;
}

SplatKernel kernel_of(const SplatKind& kind, Random& random, std::size_t count, double size) {
  switch (kind.kernel) {
    case SplatKind::Kernel::windows:
      return windows(random, count, size);
    case SplatKind::Kernel::gaussians:
      return gaussians(random, count, size, false);
    case SplatKind::Kernel::flat:
      return gaussians(random, count, size, true);
    case SplatKind::Kernel::neural:
      break;
  }
  return densities(random, count, size);
}

}  // namespace

Splats random_splats(const SplatKind& kind, std::size_t count, double size, std::uint64_t seed) {
  Random random(seed);
  Splats splats{.kernel = kernel_of(kind, random, count, size),
                .profile = *profile_named(kind.profile)};
  splats.color.degree = 2;
  splats.color.per_corner = kind.per_corner;
  for (std::size_t i = 0; i < count * coefficients_per_splat(splats.color); ++i) {
    const bool constant = i % harmonics::count(2) == 0;
    const double reach = constant ? 2.0 : 0.3;
    splats.color.coefficients.emplace_back(random.uniform(-reach, reach),
                                           random.uniform(-reach, reach),
                                           random.uniform(-reach, reach));
  }
  return splats;
}

Splats hostile_splats(const SplatKind& kind) {
  constexpr float limits[] = {0.0f, 1e-38f, 1e-20f, 1e-6f, 1.0f, 1e6f, 1e12f, 1e20f, 3e38f};
  Splats splats = random_splats(kind, 600, 0.2, 9);
  Random random(10);
  const auto limit = [&](float least, float largest) {
    for (;;)
      if (const float value = limits[random.below(9)]; value >= least && value <= largest)
        return value;
  };
  const auto signed_limit = [&] { return (random.below(2) ? 1.0f : -1.0f) * limit(0, 3e38f); };
  for (std::size_t i = 0; i < count(splats); ++i) {
    const auto axis = int(random.below(3));
    const auto which = random.below(4);
    if (which == 0) {
      splats.color.coefficients[i * harmonics::count(2) + random.below(9)][axis] = signed_limit();
      continue;
    }
    auto* windows = std::get_if<TriangleWindows>(&splats.kernel);
    if (windows && which == 3 && random.below(2)) {
      windows->corners[3 * i] = windows->corners[3 * i + 1 + random.below(2)];
      continue;
    }
    // One of the columns that have limits.
    const auto has_limits = [](const auto& column) {
      return column.range != ColumnRange::unit_length;
    };
    std::size_t columns = 0, at = 0;
    for_each_column(splats.kernel, [&](const auto& column) { columns += has_limits(column); });
    for_each_column(splats.kernel, [&](const auto& column) {
      if (!has_limits(column) || at++ != which % columns) return;
      const float value = column.range == ColumnRange::fraction   ? float(random.below(2))
                          : column.range == ColumnRange::finite   ? signed_limit()
                          : column.range == ColumnRange::positive ? limit(1e-38f, 3e38f)
                                                                  : limit(0, 3e38f);
      auto& element =
          column.values[column.per_splat * i +
                        (column.per_splat > 1 ? random.below(unsigned(column.per_splat)) : 0)];
      if constexpr (requires { element[axis]; })
        element[axis] = value;
      else if constexpr (requires { element = value; })
        element = value;
    });
  }
  return splats;
}

std::vector<float> values_of(const SplatKernel& kernel, std::size_t i) {
  std::vector<float> values;
  for_each_column(kernel, [&](const auto& column) {
    const std::span<const float> own = column.of_splat(i);
    values.insert(values.end(), own.begin(), own.end());
  });
  return values;
}

std::optional<SplatEllipsoid> ellipsoid_of(const SplatKernel& kernel, std::size_t i) {
  std::optional<SplatEllipsoid> result;
  SplatEllipsoid ellipsoid;
  for_each_column(kernel, [&](const auto& column) {
    const auto& value = column.values[column.per_splat * i];
    if (column.role == ColumnRole::scale) {
      if constexpr (requires { glm::dvec3(value); }) ellipsoid.axes = glm::dvec3(value);
      result.emplace();
    }
    if constexpr (std::is_same_v<decltype(value), const glm::vec3&>)
      if (column.role == ColumnRole::position) ellipsoid.center = value;
    if constexpr (std::is_same_v<decltype(value), const glm::quat&>) ellipsoid.rotation = value;
  });
  if (result) *result = ellipsoid;
  return result;
}

Camera camera_of_ball(double distance, int width, int height) {
  return look_at(distance * glm::normalize(glm::dvec3(1, 2, -1)), glm::dvec3(0), {0, 1, 0}, 0.8,
                 width, height);
}

}  // namespace tureen::test
