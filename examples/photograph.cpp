#include "examples/photograph.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <string>

#include "examples/glaze.hpp"
#include "examples/shapes.hpp"

namespace tureen::example {
namespace {

using std::numbers::pi;

// Half angle of the cone of reflected directions, in radians, as for glaze applied by hand. Sharper
// reflections would make the facets visible.
constexpr double blur = 0.10;

/// A direction within the cone around `axis`.
glm::dvec3 blurred(glm::dvec3 axis, Random& random) {
  const double r = std::tan(blur) * std::sqrt(random.uniform()), angle = 2 * pi * random.uniform();
  return glm::normalize(frame_along(axis) *
                        glm::dvec3(r * std::cos(angle), 1, r * std::sin(angle)));
}

std::uint8_t byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

}  // namespace

Studio::Studio(Model model, const StudioOptions& options)
    : model_(std::move(model)),
      caster_(model_),
      light_(model_, caster_, options.light),
      light_map_(model_, light_, options.light_spacing, options.threads) {}

std::optional<glm::dvec3> Studio::seen(glm::dvec3 eye, glm::dvec3 direction, Random& random) const {
  const auto hit = caster_.first_hit(eye, direction, 0);
  if (!hit) return std::nullopt;
  const std::uint32_t surface = model_.faces[hit->face].surface;
  SurfacePoint at = model_.point(surface, hit->uv);
  const Paint paint = model_.paint(at, surface);
  const glm::dvec3 diffuse = paint.albedo * light_map_.falling(surface, hit->uv);
  if (paint.gloss == 0) return displayed(diffuse);
  // Leaves are visible from both sides.
  if (glm::dot(at.normal, direction) > 0) at.normal = -at.normal;
  const glm::dvec3 mirror = glm::reflect(direction, at.normal);
  return glazed(diffuse, paint.gloss, -glm::dot(at.normal, direction),
                light_.mirrored(at, blurred(mirror, random)));
}

Image8 Studio::photograph(const Camera& camera, int strata) const {
  const glm::dvec3 eye = camera.eye();
  const glm::dmat3 rotation = camera.world_from_view_rotation();
  Image8 image(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      Random random(mixed(std::uint64_t(y) << 32 | std::uint64_t(x)));
      glm::dvec3 sum(0);
      int covered = 0;
      for (int i = 0; i < strata * strata; ++i) {
        const int column = i % strata, row = i / strata;
        const double px = x + (column + random.uniform()) / strata;
        const double py = y + (row + random.uniform()) / strata;
        const glm::dvec3 view((px - camera.cx) / camera.fx, (camera.cy - py) / camera.fy, -1);
        if (const auto color = seen(eye, glm::normalize(rotation * view), random)) {
          sum += *color;
          ++covered;
        }
      }
      if (covered == 0) continue;
      const glm::dvec3 mean = sum / double(covered);
      image.at(x, y) = {byte(mean.r), byte(mean.g), byte(mean.b),
                        byte(double(covered) / (strata * strata))};
    }
  return image;
}

std::vector<Camera> example_cameras(int count, int size, double turn) {
  // From slightly below the table top, where its rim is visible, to nearly above.
  const double lowest = std::sin(-4 * pi / 180), highest = std::sin(86 * pi / 180);
  const double distance = 8.6, fov = 35 * pi / 180;
  const glm::dvec3 target(0, 0.55, 0);
  std::vector<Camera> cameras;
  for (int i = 0; i < count; ++i) {
    const double step = i + 0.5 + turn;
    const double y = highest + (lowest - highest) * step / count, r = std::sqrt(1 - y * y);
    const double angle = 2 * pi * step / std::numbers::phi;
    const glm::dvec3 direction(r * std::cos(angle), y, r * std::sin(angle));
    Camera camera = look_at(target + distance * direction, target, {0, 1, 0}, fov, size, size);
    const std::string number = std::to_string(i);
    camera.name = "r_" + std::string(number.size() < 3 ? 3 - number.size() : 0, '0') + number;
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

}  // namespace tureen::example
