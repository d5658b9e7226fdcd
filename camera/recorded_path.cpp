#include "camera/recorded_path.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <iterator>
#include <numeric>
#include <string>

#include "camera/view_state.hpp"
#include "scene/region.hpp"
#include "scene/upper_median.hpp"

namespace tureen {

namespace {

constexpr std::size_t max_cameras = 1000;

/// What orders and paths use from a camera.
struct Pose {
  glm::dvec3 eye, forward, up;
};

struct Tour {
  std::vector<Pose> poses;
  // The distance, in world units, that counts as much as a turn by one radian: that between the
  // cameras and their subject.
  double turn_length = 1;

  double step(std::size_t a, std::size_t b) const {
    // A chord is as good a measure as the angle, and cheaper.
    return glm::distance(poses[a].eye, poses[b].eye) +
           turn_length * glm::distance(poses[a].forward, poses[b].forward);
  }
  double length(const std::vector<std::size_t>& order) const {
    double sum = 0;
    for (std::size_t i = 1; i < order.size(); ++i) sum += step(order[i - 1], order[i]);
    return sum;
  }
};

/// Whether the matrix turns and moves by finite numbers, within the rounding of floats, and the
/// image and the focal lengths have a size.
bool is_pinhole(const Camera& camera) {
  const glm::dmat3 axes = camera.world_from_view_rotation();
  for (int column = 0; column < 3; ++column)
    if (!(std::abs(glm::length(axes[column]) - 1) < 1e-4)) return false;
  return glm::length(camera.eye()) < 1e100 && camera.width > 0 && camera.height > 0 &&
         camera.fy > 0 && camera.fy < 1e100;
}

Tour tour_of(std::span<const Camera> cameras) {
  Tour tour;
  glm::dvec3 middle(0.0);
  for (const Camera& camera : cameras) {
    const glm::dmat3 axes = camera.world_from_view_rotation();
    tour.poses.push_back({camera.eye(), -axes[2], axes[1]});
    middle += camera.eye() / double(cameras.size());
  }
  const glm::dvec3 center = looked_at_point(cameras).value_or(middle);
  std::vector<double> distances;
  for (const Pose& pose : tour.poses) distances.push_back(glm::distance(pose.eye, center));
  const double distance = upper_median(std::move(distances));
  if (distance > 0 && std::isfinite(distance)) tour.turn_length = distance;
  return tour;
}

/// Begins at the first camera and goes on to the nearest that is left.
std::vector<std::size_t> nearest_next(const Tour& tour) {
  std::vector<std::size_t> order(tour.poses.size());
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t i = 1; i < order.size(); ++i)
    std::iter_swap(order.begin() + std::ptrdiff_t(i),
                   std::min_element(order.begin() + std::ptrdiff_t(i), order.end(),
                                    [&](std::size_t a, std::size_t b) {
                                      return tour.step(order[i - 1], a) <
                                             tour.step(order[i - 1], b);
                                    }));
  return order;
}

/// Reverses parts of a closed tour while that makes it shorter (G. A. Croes, "A method for solving
/// traveling-salesman problems", Operations Research 6, 1958).
void reverse_parts(const Tour& tour, std::vector<std::size_t>& order) {
  constexpr int most_rounds = 20;  // a few are enough; each is O(n^2)
  const std::size_t count = order.size();
  bool shorter = true;
  for (int round = 0; round < most_rounds && shorter; ++round) {
    shorter = false;
    for (std::size_t i = 0; i + 2 < count; ++i)
      for (std::size_t j = i + 1; j < count - (i == 0); ++j) {
        const std::size_t before = order[(i + count - 1) % count], after = order[(j + 1) % count];
        const double now = tour.step(before, order[i]) + tour.step(order[j], after);
        const double then = tour.step(before, order[j]) + tour.step(order[i], after);
        // Rounding must not make two tours shorter than each other.
        if (!(then < now * (1 - 1e-9))) continue;
        std::reverse(order.begin() + std::ptrdiff_t(i), order.begin() + std::ptrdiff_t(j) + 1);
        shorter = true;
      }
  }
}

/// Opens a closed tour at its longest step.
void open_at_longest(const Tour& tour, std::vector<std::size_t>& order) {
  double longest = tour.step(order.back(), order.front());
  std::size_t first = 0;
  for (std::size_t i = 1; i < order.size(); ++i)
    if (const double step = tour.step(order[i - 1], order[i]); step > longest) {
      longest = step;
      first = i;
    }
  std::rotate(order.begin(), order.begin() + std::ptrdiff_t(first), order.end());
}

std::vector<std::size_t> order_of(const Tour& tour) {
  std::vector<std::size_t> recorded(tour.poses.size());
  std::iota(recorded.begin(), recorded.end(), 0);
  std::vector<std::size_t> found = nearest_next(tour);
  reverse_parts(tour, found);
  open_at_longest(tour, found);
  return tour.length(recorded) <= 1.2 * tour.length(found) ? recorded : found;
}

/// Places of the cameras along their tour, from 0; each camera's place is on all rounds of a loop.
struct Line {
  std::vector<Pose> poses;
  std::vector<double> at;
  double length = 0;
  bool is_loop = false;

  /// The mean about a place.
  Pose near(double place, double width) const {
    Pose sum{glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)};
    double weights = 0;
    std::size_t nearest = 0;
    double least = length;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      double apart = std::abs(at[i] - place);
      if (is_loop) apart = std::min(apart, length - apart);
      if (apart < least) {
        least = apart;
        nearest = i;
      }
      // The camera nearest to the place has a weight of more than exp(-n^2 / 8) in a tour of n
      // equal steps, so the sum of long tours is no less.
      const double weight = std::exp(-0.5 * (apart / width) * (apart / width));
      sum.eye += weight * poses[i].eye;
      sum.forward += weight * poses[i].forward;
      sum.up += weight * poses[i].up;
      weights += weight;
    }
    const Pose& one = poses[nearest];
    // Far from all cameras, the weights vanish; opposite lines of sight have no mean.
    if (!(weights > 1e-9) || !(glm::length(sum.forward) > 1e-3 * weights)) return one;
    return {sum.eye / weights, glm::normalize(sum.forward), sum.up};
  }
};

}  // namespace

std::vector<std::size_t> order_along(std::span<const Camera> cameras) {
  return order_of(tour_of(cameras));
}

CameraPathData path_along(std::span<const Camera> cameras, std::optional<double> seconds) {
  std::vector<Camera> some;
  std::copy_if(cameras.begin(), cameras.end(), std::back_inserter(some), is_pinhole);
  const std::size_t count = std::min(some.size(), max_cameras);
  if (count == 0) return {};
  for (std::size_t i = 0; i < count; ++i) some[i] = some[i * some.size() / count];
  some.resize(count);

  const Tour tour = tour_of(some);
  const std::vector<std::size_t> order = order_of(tour);
  Line line;
  std::vector<double> steps;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) steps.push_back(tour.step(order[i - 1], order[i]));
    line.length += i > 0 ? steps.back() : 0;
    line.at.push_back(line.length);
    line.poses.push_back(tour.poses[order[i]]);
  }
  // The way back is not longer than the ways between: three median steps allow for gaps.
  const double back = tour.step(order.back(), order.front());
  if (count > 3 && back <= 3 * upper_median(steps)) {
    line.is_loop = true;
    line.length += back;
  }

  // An interval holds about three cameras, so that one that was held unsteadily does not show.
  const std::size_t keys =
      line.length > 0 ? std::clamp<std::size_t>(count / 3, std::min<std::size_t>(count, 4), 60) : 1;
  const std::size_t intervals = line.is_loop ? keys : std::max<std::size_t>(keys - 1, 1);
  const double interval = line.length / double(intervals);
  const double duration =
      seconds.value_or(std::clamp(line.length / (0.5 * tour.turn_length), 4.0, 120.0));

  std::vector<double> focals;
  for (const Camera& camera : some) focals.push_back(camera.fy / camera.height);
  const ViewLens lens{.focal = upper_median(std::move(focals))};
  CameraPathData path;
  for (std::size_t i = 0; i < keys; ++i) {
    const Pose pose = keys > 1 ? line.near(double(i) * interval, interval) : line.poses.front();
    // Mean up axes lie across the mean line of sight, except for a camera that rolls over.
    glm::dvec3 right = glm::cross(pose.forward, pose.up);
    if (!(glm::length(right) > 1e-6))
      right = glm::cross(pose.forward, glm::dvec3(pose.forward.y, pose.forward.z, pose.forward.x));
    right = glm::normalize(right);
    const glm::dmat3 axes(right, glm::cross(right, pose.forward), -pose.forward);
    Camera camera = camera_of(lens, axes, pose.eye, some.front().width, some.front().height);
    camera.name = "along cameras " + std::to_string(i);
    path.keyframes.push_back({std::move(camera), duration * double(i) / double(intervals)});
  }
  if (line.is_loop && keys > 1) path.loop_seconds = duration;
  return path;
}

}  // namespace tureen
