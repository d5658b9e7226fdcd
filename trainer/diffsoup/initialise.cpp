#include "trainer/diffsoup/initialise.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numeric>
#include <tuple>
#include <variant>

#include "base/error.hpp"
#include "trainer/common/neighbours.hpp"
#include "trainer/common/random_points.hpp"
#include "trainer/diffsoup/backing.hpp"
#include "trainer/diffsoup/mlp_parameters.hpp"
#include "trainer/diffsoup/split_choice.hpp"

namespace tureen::trainer {

namespace {

constexpr std::uint64_t begin_stream = 2;

/// Gaussians of a scene among which the first triangles choose their places.
constexpr std::size_t max_seed_gaussians = 100'000;

/// The opacity of the backing layer begins at 0.998. It is the last surface of every ray, so
/// training has no reason to lower it.
constexpr float backing_logit = 6.0f;

double mean(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / double(values.size());
}

/// The positions in their order, without repeats of earlier ones.
std::vector<glm::dvec3> once_each(const std::vector<glm::dvec3>& points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&points](std::uint32_t i) {
    return std::tuple(points[i].x, points[i].y, points[i].z, i);
  };
  std::ranges::sort(order, {}, key);
  std::vector<bool> repeated(points.size(), false);
  for (std::size_t i = 1; i < order.size(); ++i)
    repeated[order[i]] = points[order[i]] == points[order[i - 1]];
  std::vector<glm::dvec3> kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!repeated[i]) kept.push_back(points[i]);
  return kept;
}

/// The positions without likely outliers: see seeds_at_points.
std::vector<glm::dvec3> plausible(std::span<const DatasetPoint> points) {
  glm::dvec3 center;
  std::vector<double> values(points.size());
  const auto quantile = [&values](double fraction) {
    const auto at = values.begin() + std::ptrdiff_t(fraction * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(points, values.begin(),
                           [axis](const DatasetPoint& point) { return point.position[axis]; });
    center[axis] = quantile(0.5);
  }
  std::ranges::transform(points, values.begin(), [&center](const DatasetPoint& point) {
    return glm::distance(point.position, center);
  });
  const double farthest = 2 * quantile(0.995);
  std::vector<glm::dvec3> kept;
  for (const DatasetPoint& point : points)
    if (glm::distance(point.position, center) <= farthest) kept.push_back(point.position);
  return once_each(kept);
}

/// All points, and random positions near them, `count` together.
std::vector<glm::dvec3> extended(const std::vector<glm::dvec3>& points, std::size_t count,
                                 double lone_spacing, Random& random) {
  std::vector<double> distances = nearest_distances(points);
  if (points.size() == 1) distances[0] = lone_spacing;
  std::vector<glm::dvec3> all = points;
  while (all.size() < count) {
    const std::size_t beside = random.below(points.size());
    all.push_back(points[beside] + distances[beside] * random.in_ball());
  }
  return all;
}

std::vector<glm::dvec3> thinned(const std::vector<glm::dvec3>& points, std::size_t count,
                                Random& random) {
  const std::size_t spread = (2 * count + 2) / 3;  // two thirds, rounded up
  const auto first = std::uint32_t(random.below(points.size()));
  std::vector<glm::dvec3> chosen;
  std::vector<bool> taken(points.size(), false);
  for (const std::uint32_t i : farthest_points(points, spread, first)) {
    chosen.push_back(points[i]);
    taken[i] = true;
  }
  std::vector<glm::dvec3> others;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!taken[i]) others.push_back(points[i]);
  for (const std::uint32_t i : draw(random, count - chosen.size(), others.size()))
    chosen.push_back(others[i]);
  return chosen;
}

/// The rotation whose third axis is the unit vector `normal`, turned around it by `random`.
glm::dmat3 in_plane(glm::dvec3 normal, const glm::dmat3& random) {
  // One of two perpendicular axes is at least 45 degrees away from the normal.
  const glm::dvec3 aside =
      std::abs(glm::dot(random[0], normal)) < std::sqrt(0.5) ? random[0] : random[1];
  const glm::dvec3 x = glm::normalize(aside - glm::dot(aside, normal) * normal);
  return {x, glm::cross(normal, x), normal};
}

/// The unit vector along the shortest axis of a Gaussian.
glm::dvec3 shortest_axis(const Gaussians& gaussians, std::size_t i) {
  const glm::vec3 scales = gaussians.scales[i];
  int axis = 2;
  if (!gaussians.flat)
    for (int other = 0; other < 2; ++other)
      if (scales[other] < scales[axis]) axis = other;
  return glm::normalize(glm::dmat3(glm::mat3_cast(glm::dquat(gaussians.rotations[i])))[axis]);
}

Model grey_model(const Config& config, glm::dvec3 origin, std::vector<glm::vec3> positions) {
  Model model{.min_level = config.coarse_level,
              .max_level = config.coarse_level,
              .positions = std::move(positions),
              .logits = {},
              .mlp = initial_mlp(config.seed),
              .origin = origin};
  model.logits.assign(model.faces() * model.texels() * channels, 0.0f);
  return model;
}

Model from_mesh(const Scene& mesh, const Config& config) {
  const Model model = from_scene(
      mesh,
      {.min_level = config.coarse_level, .max_level = config.coarse_level, .seed = config.seed});
  const std::vector<Split> splits = longest_edges(model, std::size_t(config.initial_triangles));
  return split(model, splits, ChildTexture::resampled).model;
}

const Gaussians* gaussians_of(const Scene* scene) {
  const auto* splats = scene ? std::get_if<Splats>(&only_layer(*scene).primitives) : nullptr;
  return splats ? std::get_if<Gaussians>(&splats->kernel) : nullptr;
}

/// Replaces the seeds inside the region with seeds at points.
void put_at_points(const Dataset& dataset, const Region& region, std::size_t count,
                   const Config& config, double far, Seeds& seeds, Random& random) {
  const std::size_t at = count - std::size_t(std::llround(far * double(count)));
  seeds.centers.resize(count);
  seeds.radii.resize(count);
  if (at == 0) return;
  const Seeds points = seeds_at_points(dataset.points,
                                       {.count = at,
                                        .radius = config.initial_radius,
                                        .local = config.local_radius,
                                        .lone_spacing = region.half_side},
                                       random);
  std::ranges::copy(points.centers, seeds.centers.begin());
  std::ranges::copy(points.radii, seeds.radii.begin());
}

}  // namespace

Seeds seeds_at_points(std::span<const DatasetPoint> points, const PointSeeds& options,
                      Random& random) {
  assert(!points.empty());
  const std::vector<glm::dvec3> kept = plausible(points);
  Seeds seeds;
  seeds.centers = kept.size() < options.count
                      ? extended(kept, options.count, options.lone_spacing, random)
                      : thinned(kept, options.count, random);
  seeds.radii = nearest_distances(seeds.centers);
  double mean_distance = mean(seeds.radii);
  if (!(mean_distance > 0)) mean_distance = options.lone_spacing;
  for (double& radius : seeds.radii)
    radius =
        options.radius * (options.local ? std::max(radius, 0.1 * mean_distance) : mean_distance);
  return seeds;
}

Seeds seeds_at_gaussians(const Gaussians& gaussians, glm::dvec3 origin, const PointSeeds& options,
                         Random& random) {
  std::vector<DatasetPoint> points;
  std::vector<glm::dvec3> centers, normals;
  for (const float needed : {0.5f, 0.0f}) {
    for (std::size_t i = 0; i < gaussians.centers.size(); ++i) {
      if (gaussians.opacity[i] < needed) continue;
      centers.push_back(origin + glm::dvec3(gaussians.centers[i]));
      normals.push_back(shortest_axis(gaussians, i));
      points.push_back({.position = centers.back(), .color = {}});
    }
    if (!points.empty()) break;
  }
  // Sampling takes points x seeds steps.
  if (points.size() > max_seed_gaussians) {
    std::vector<DatasetPoint> drawn;
    for (const std::uint32_t i : draw(random, max_seed_gaussians, points.size()))
      drawn.push_back(points[i]);
    points = std::move(drawn);
  }
  Seeds seeds = seeds_at_points(points, options, random);
  for (const std::uint32_t nearest : nearest_points(centers, seeds.centers))
    seeds.normals.push_back(normals[nearest]);
  return seeds;
}

Seeds random_seeds(const Region& region, std::span<const Photograph> views,
                   const RandomSeeds& options, Random& random) {
  const auto near_count =
      options.count - std::size_t(std::llround(options.far * double(options.count)));
  const auto seen = [&views](glm::dvec3 point) {
    return std::ranges::any_of(
        views, [&](const Photograph& view) { return in_image(view.camera, point); });
  };
  Seeds seeds;
  while (seeds.centers.size() < options.count) {
    const bool is_near = seeds.centers.size() < near_count;
    glm::dvec3 point;
    for (int attempt = 0; attempt < 100; ++attempt) {
      point = is_near ? near_point(region, random) : far_point(region, options.far_extent, random);
      if (seen(point)) break;
    }
    seeds.centers.push_back(point);
  }
  const std::span<const glm::dvec3> all = seeds.centers;
  double spacing = mean(nearest_distances(all.first(near_count)));
  if (!(spacing > 0)) spacing = region.half_side;  // one point, or none
  for (const glm::dvec3 center : seeds.centers) {
    const double distance = glm::distance(center, region.center) / region.half_side;
    const bool is_near = seeds.radii.size() < near_count;
    seeds.radii.push_back(options.radius * spacing * (is_near ? 1.0 : distance));
  }
  return seeds;
}

std::vector<glm::vec3> equilateral_triangles(const Seeds& seeds, glm::dvec3 origin,
                                             Random& random) {
  assert(seeds.centers.size() == seeds.radii.size());
  assert(seeds.normals.empty() || seeds.normals.size() == seeds.centers.size());
  const double sine = std::sqrt(0.75);  // of 120 degrees
  const glm::dvec3 corners[] = {{1, 0, 0}, {-0.5, sine, 0}, {-0.5, -sine, 0}};
  std::vector<glm::vec3> positions;
  positions.reserve(3 * seeds.centers.size());
  for (std::size_t i = 0; i < seeds.centers.size(); ++i) {
    glm::dmat3 rotation = random.rotation();
    if (!seeds.normals.empty()) rotation = in_plane(seeds.normals[i], rotation);
    for (const glm::dvec3 corner : corners)
      positions.emplace_back(seeds.centers[i] - origin + seeds.radii[i] * (rotation * corner));
  }
  return positions;
}

Model initial_model(const Dataset& dataset, const Config& config, const Scene* start) {
  assert(start || config.initialisation != Initialisation::mesh);
  const Gaussians* gaussians = gaussians_of(start);
  if (start && !gaussians) return from_mesh(*start, config);
  if (gaussians && gaussians->centers.empty()) gaussians = nullptr;
  const bool has_points = !dataset.points.empty();
  if (config.initialisation == Initialisation::points && !has_points)
    throw InputError({}, "the dataset has no points for the first triangles",
                     "use random initialisation");
  const std::size_t backing = backing_faces(config);
  const std::size_t count = std::max(std::size_t(config.initial_triangles), backing + 1) - backing;
  Region region = region_of_interest(dataset);
  Random random(config.seed, begin_stream);
  const bool at_points =
      has_points && config.initialisation != Initialisation::random && !gaussians;
  if (config.box > 0 && !at_points) region.half_side = config.box;
  const double far = at_points ? config.around_points : config.far_points;
  Seeds seeds;
  if (gaussians)
    seeds = seeds_at_gaussians(*gaussians, origin_of(only_layer(*start)),
                               {.count = count,
                                .radius = config.initial_radius,
                                .local = true,
                                .lone_spacing = region.half_side},
                               random);
  else if (!at_points || far > 0)
    seeds = random_seeds(region, dataset.train,
                         {.count = count,
                          .radius = config.initial_radius,
                          .far = far,
                          .far_extent = config.far_extent},
                         random);
  if (at_points) put_at_points(dataset, region, count, config, far, seeds, random);
  std::vector<glm::vec3> positions =
      backing_sphere(backing, backing_radius(config, dataset, region, seeds.centers));
  const std::vector<glm::vec3> others = equilateral_triangles(seeds, region.center, random);
  positions.insert(positions.end(), others.begin(), others.end());
  Model model = grey_model(config, region.center, std::move(positions));
  for (std::size_t texel = 0; texel < backing * model.texels(); ++texel)
    model.logits[texel * channels + alpha_channel] = backing_logit;
  return model;
}

}  // namespace tureen::trainer
