#include "trainer/splats/gaussian_initialise.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "base/error.hpp"
#include "scene/edit/mean_color.hpp"
#include "scene/edit/moved_splats.hpp"
#include "trainer/common/neighbours.hpp"
#include "trainer/splats/gaussian_trainer.hpp"

namespace tureen::trainer {

namespace {

namespace row = splatting::gaussian_row;

/// The value of the constant spherical harmonic, 1 / (2 sqrt(pi)).
constexpr double harmonic_0 = 0.28209479177387814;

struct ColoredPoint {
  glm::dvec3 position;  // relative to the region's centre
  glm::vec3 color;
};

void put(GaussianParameters& parameters, std::size_t i, const ColoredPoint& point, double scale,
         float opacity) {
  for (int axis = 0; axis < 3; ++axis) {
    parameters.trained(row::x + std::size_t(axis))[i] = float(point.position[axis]);
    parameters.trained(row::scale_x + std::size_t(axis))[i] = float(std::log(scale));
    parameters.trained(row::harmonics + std::size_t(axis))[i] =
        float((double(point.color[axis]) - 0.5) / harmonic_0);
  }
  parameters.trained(row::rotation_w)[i] = 1;
  parameters.trained(row::opacity)[i] = std::log(opacity / (1 - opacity));
  parameters.activate(i);
}

/// Puts round Gaussians at the points into the first places of `parameters`. `spacing`: the scale
/// of a single point.
void put_all(GaussianParameters& parameters, const std::vector<ColoredPoint>& points,
             const GaussianConfig& config, double half_side, double spacing) {
  std::vector<glm::dvec3> positions;
  for (const ColoredPoint& point : points) positions.push_back(point.position);
  const std::vector<double> distances = nearest_distances(positions, 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = points.size() > 1 ? distances[i] : spacing;
    // Coincident points have distance 0.
    const double scale = std::clamp(distance, double(config.min_scale) * half_side,
                                    double(config.max_scale) * half_side);
    put(parameters, i, points[i], scale, config.first_opacity);
  }
}

GaussianParameters at_points(const Dataset& dataset, const GaussianConfig& config,
                             const Region& region, Random& random) {
  std::vector<std::uint32_t> chosen =
      draw(random, std::size_t(config.max_splats), dataset.points.size());
  std::sort(chosen.begin(), chosen.end());
  std::vector<ColoredPoint> points;
  for (const std::uint32_t i : chosen) {
    const DatasetPoint& point = dataset.points[i];
    points.push_back({point.position - region.centre, glm::vec3(point.color) / 255.0f});
  }
  GaussianConfig filled = config;
  filled.first_splats =
      std::max<std::uint64_t>(std::min(config.first_splats, config.max_splats), points.size());
  // The points replace the first of the random ones.
  GaussianParameters result =
      random_gaussians(filled, {.centre = glm::dvec3(0), .half_side = region.half_side}, random);
  put_all(result, points, config, region.half_side,
          region.half_side / std::cbrt(double(filled.first_splats)));
  return result;
}

/// `count` points on the triangles, uniform in area.
std::vector<ColoredPoint> samples(const Scene& scene, const Region& region, std::size_t count,
                                  Random& random) {
  const TriangleSoup& soup = only_soup(scene);
  const glm::dmat4 place = only_layer(scene).world_from_layer;
  const std::vector<glm::vec3> colors = mean_colors(soup);
  const auto corner = [&](std::size_t triangle, int k) {
    const glm::vec3 position = soup.positions[soup.triangles[triangle][k]];
    return glm::dvec3(place * glm::dvec4(glm::dvec3(position), 1.0));
  };
  std::vector<double> areas;  // sums of twice the areas up to each triangle
  double sum = 0;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const glm::dvec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    const double area = glm::length(glm::cross(b - a, c - a));
    if (std::isfinite(area)) sum += area;
    areas.push_back(sum);
  }
  if (!(sum > 0)) throw InputError({}, "the initial scene has no triangle with an area");
  std::vector<ColoredPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = random.uniform(0, sum);
    const auto t =
        std::size_t(std::upper_bound(areas.begin(), areas.end() - 1, at) - areas.begin());
    const double u = std::sqrt(random.uniform()), v = random.uniform();
    const glm::dvec3 position =
        (1 - u) * corner(t, 0) + u * (1 - v) * corner(t, 1) + u * v * corner(t, 2);
    points.push_back({position - region.centre, colors[t]});
  }
  return points;
}

GaussianParameters from_scene(const Scene& scene, const GaussianConfig& config,
                              const Region& region, Random& random) {
  const Layer& layer = only_layer(scene);
  if (std::holds_alternative<TriangleSoup>(layer.primitives)) {
    const auto count = std::size_t(std::min(config.first_splats, config.max_splats));
    GaussianParameters result(count, config.degree);
    put_all(result, samples(scene, region, count, random), config, region.half_side,
            region.half_side);
    return result;
  }
  Splats splats = std::get<Splats>(layer.primitives);
  move_splats(splats, at_origin(-region.centre) * layer.world_from_layer);
  const auto* gaussians = std::get_if<Gaussians>(&splats.kernel);
  if (!gaussians || gaussians->flat)
    throw InputError({}, std::string("the initial scene has ") + kernel_name(splats.kernel) +
                             "; the training of Gaussians begins with Gaussians or triangles");
  if (gaussians->centers.empty()) throw InputError({}, "the initial scene has no splat");
  if (gaussians->centers.size() > config.max_splats)
    throw InputError({},
                     "the initial scene has " + std::to_string(gaussians->centers.size()) +
                         " splats, more than max_splats, " + std::to_string(config.max_splats),
                     "allow more splats, or convert the scene to one with fewer");
  return GaussianParameters(*gaussians, splats.color, config.degree);
}

}  // namespace

GaussianParameters initial_gaussians(const Dataset& dataset, const GaussianConfig& config,
                                     const Region& region, const Scene* start, Random& random) {
  assert((start != nullptr) == (config.initialisation == Initialisation::mesh));
  if (start) return from_scene(*start, config, region, random);
  if (config.initialisation == Initialisation::points && dataset.points.empty())
    throw InputError({}, "the dataset has no points for the first splats",
                     "use random initialisation");
  if (!dataset.points.empty() && config.initialisation != Initialisation::random)
    return at_points(dataset, config, region, random);
  GaussianConfig limited = config;
  limited.first_splats = std::min(config.first_splats, config.max_splats);
  return random_gaussians(limited, {.centre = glm::dvec3(0), .half_side = region.half_side},
                          random);
}

}  // namespace tureen::trainer
