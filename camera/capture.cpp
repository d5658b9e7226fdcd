#include "camera/capture.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>

#include "scene/region.hpp"
#include "scene/upper_median.hpp"

namespace tureen {

namespace {

/// Large if the camera's view differs from one that looks at the centre from `ideal`, a direction:
/// the sum of the differences of position and line of sight, as chords of a unit circle, and of the
/// logarithms of the distances.
double unlikeness(const Camera& camera, const Capture& capture, const glm::dvec3& ideal) {
  const glm::dvec3 from_center = camera.eye() - capture.center;
  const double distance = glm::length(from_center);
  const glm::dvec3 direction = from_center / distance;
  const double sum = glm::distance(direction, ideal) +
                     glm::distance(direction, camera.world_from_view_rotation()[2]) +
                     std::abs(std::log(distance / capture.distance));
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

}  // namespace

std::optional<Capture> capture_of(std::span<const Camera> cameras, const glm::dvec3& up) {
  if (cameras.size() < 3 || !(glm::length(up) > 0)) return std::nullopt;
  const std::optional<glm::dvec3> center = looked_at_point(cameras);
  if (!center) return std::nullopt;
  Capture capture{.center = *center, .up = glm::normalize(up)};
  const glm::dvec3 front = direction_of(capture.up, {}), side = glm::cross(capture.up, front);
  std::vector<double> distances, elevations, half_tangents;
  std::vector<double> azimuths;
  glm::dvec3 mean(0.0);  // of the horizontal directions
  for (const Camera& camera : cameras) {
    const glm::dvec3 from_center = camera.eye() - *center;
    const double height = glm::dot(from_center, capture.up);
    const glm::dvec3 level = from_center - height * capture.up;
    const double reach = glm::length(level);
    distances.push_back(glm::length(from_center));
    elevations.push_back(std::atan2(height, reach));
    half_tangents.push_back(
        std::min(0.5 * camera.width / camera.fx, 0.5 * camera.height / camera.fy));
    if (!(reach > 0)) continue;
    mean += level / (reach * double(cameras.size()));
    azimuths.push_back(std::atan2(glm::dot(level, side), glm::dot(level, front)));
  }
  capture.distance = upper_median(std::move(distances));
  capture.half_tangent = upper_median(std::move(half_tangents));
  // Straight down, left and right would be undefined.
  constexpr double highest = 85 * degree;
  capture.bearing.elevation = std::clamp(upper_median(std::move(elevations)), -highest, highest);
  capture.bearing.azimuth = three_quarter_view.azimuth;
  if (!(glm::length(mean) < 0.5) && !azimuths.empty()) {
    const double middle = std::atan2(glm::dot(mean, side), glm::dot(mean, front));
    for (double& azimuth : azimuths) azimuth = std::remainder(azimuth - middle, full_turn);
    std::sort(azimuths.begin(), azimuths.end());
    const std::size_t cut = azimuths.size() / 20;
    const double low = azimuths[cut], high = azimuths[azimuths.size() - 1 - cut];
    capture.bearing.azimuth = middle + 0.5 * (low + high);
    // From one point, a small turn still shows depth.
    capture.reach = std::max(0.5 * (high - low), 5 * degree);
  }
  if (!(capture.distance > 0) || !std::isfinite(capture.distance) || !(capture.half_tangent > 0) ||
      !std::isfinite(capture.half_tangent))
    return std::nullopt;
  return capture;
}

std::optional<Capture> capture_of(std::span<const Camera> cameras, const glm::dvec3& up,
                                  std::span<const LayerPlace> boxes) {
  const std::optional<Capture> capture = capture_of(cameras, up);
  if (!capture || !capture->is_all_around()) return capture;
  const bool is_place = std::any_of(boxes.begin(), boxes.end(), [&](const LayerPlace& box) {
    return most_are_inside(box, cameras);
  });
  return is_place ? capture : std::nullopt;
}

Lens lens_of(const Capture& capture, int width, int height) {
  const double half_height =
      width >= height ? capture.half_tangent : capture.half_tangent * height / width;
  return {.width = width, .height = height, .fov_y = 2 * std::atan(half_height)};
}

Camera view_of(const Capture& capture, double turn, const Lens& lens) {
  const Bearing bearing{capture.bearing.azimuth + turn, capture.bearing.elevation};
  return look_at(capture.center + capture.distance * direction_of(capture.up, bearing),
                 capture.center, capture.up, lens.fov_y, lens.width, lens.height);
}

std::vector<Camera> orbit(const Capture& capture, int count, const Lens& lens) {
  std::vector<Camera> cameras;
  for (int i = 0; i < count; ++i) {
    const double turn = capture.is_all_around() ? full_turn * i / count
                        : count > 1             ? capture.reach * (2.0 * i / (count - 1) - 1)
                                                : 0;
    cameras.push_back(view_of(capture, turn, lens));
    cameras.back().name = "orbit " + std::to_string(i);
  }
  return cameras;
}

CameraPathData turntable(const Capture& capture, const Lens& lens, double seconds) {
  constexpr int keyframes = 16;  // an eighth of a sine's period is nearly straight
  CameraPathData path{.keyframes = {}, .loop_seconds = seconds};
  for (int i = 0; i < keyframes; ++i) {
    const double angle = full_turn * i / keyframes;
    Camera camera =
        view_of(capture, capture.is_all_around() ? angle : capture.reach * std::sin(angle), lens);
    camera.name = "turntable " + std::to_string(i);
    path.keyframes.push_back({std::move(camera), seconds * i / keyframes, capture.distance});
  }
  return path;
}

std::optional<Camera> first_view_of(const std::optional<Camera>& stored,
                                    std::span<const Camera> cameras, const glm::dvec3& up) {
  if (stored || cameras.empty()) return stored;
  const std::optional<Capture> capture = capture_of(cameras, up);
  if (!capture) return cameras.front();
  const glm::dvec3 ideal = direction_of(capture->up, capture->bearing);
  return *std::min_element(cameras.begin(), cameras.end(), [&](const Camera& a, const Camera& b) {
    return unlikeness(a, *capture, ideal) < unlikeness(b, *capture, ideal);
  });
}

Camera whole_in(const glm::dvec2& size, Camera first_view) {
  constexpr double max_side = 1e7;  // fits an int
  const double height = std::ceil(first_view.width * size.y / size.x);
  if (!(height > first_view.height && height < max_side)) return first_view;
  first_view.cy += 0.5 * (height - first_view.height);
  first_view.height = int(height);
  return first_view;
}

}  // namespace tureen
