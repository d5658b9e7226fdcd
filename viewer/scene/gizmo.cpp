#include "viewer/scene/gizmo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "scene/scene.hpp"
#include "scene/similarity.hpp"
#include "viewer/axes.hpp"

namespace tureen::viewer {

namespace {

using Kind = GizmoHandle::Kind;

// Parts of an arm: where an arrow begins, and the square of a plane.
constexpr double arrow_begin = 0.15, square_low = 0.35, square_high = 0.6;
/// Sines of the smallest angles between the line of sight and an arrow, or a plane, that can be
/// dragged: nearer, a point of the pointer is ten times as much in the world, or more.
constexpr double least_arrow_sine = 0.1, least_plane_sine = 0.15;
/// Above this sine a ring follows the pointer around its centre; below, it is too narrow for that,
/// and turns by the way along it.
constexpr double round_ring_sine = 0.4;
constexpr int ring_points = 64;
constexpr double snapped_degrees = 15, snapped_factor = 0.1;
/// Of a drag: more is no intention.
constexpr double least_factor = 1e-3, most_factor = 1e3;

glm::dvec3 ray(const Camera& camera, const glm::dvec2& at) {
  const glm::dvec3 in_view((at.x - camera.cx) / camera.fx, (camera.cy - at.y) / camera.fy, -1);
  return glm::normalize(camera.world_from_view_rotation() * in_view);
}

/// The sine of the angle between the line of sight and the axis.
double sine_to(const Gizmo& gizmo, const glm::dvec3& axis) {
  return glm::length(glm::cross(glm::normalize(gizmo.center - gizmo.camera.eye()), axis));
}
double sine_to_plane(const Gizmo& gizmo, const glm::dvec3& normal) {
  return std::abs(glm::dot(glm::normalize(gizmo.center - gizmo.camera.eye()), normal));
}

/// The place on the axis, from the centre, that is nearest to the ray.
std::optional<double> along(const Gizmo& gizmo, const glm::dvec3& axis, const glm::dvec2& at) {
  const glm::dvec3 direction = ray(gizmo.camera, at), to_eye = gizmo.camera.eye() - gizmo.center;
  const double cosine = glm::dot(axis, direction), square = 1 - cosine * cosine;
  if (square < least_arrow_sine * least_arrow_sine) return {};
  return (glm::dot(axis, to_eye) - cosine * glm::dot(direction, to_eye)) / square;
}

/// Where the ray meets the plane through the centre, from the centre.
std::optional<glm::dvec3> in_plane(const Gizmo& gizmo, const glm::dvec3& normal,
                                   const glm::dvec2& at) {
  const glm::dvec3 direction = ray(gizmo.camera, at), to_eye = gizmo.camera.eye() - gizmo.center;
  const double slope = glm::dot(direction, normal), t = -glm::dot(to_eye, normal) / slope;
  // A drag may go on at a smaller angle than that at which it can begin: perspective makes it
  // smaller away from the centre.
  if (std::abs(slope) < 0.5 * least_plane_sine || !(t > 0)) return {};
  return to_eye + t * direction;
}

/// The points of the ring that face the eye, in its order.
std::vector<glm::dvec3> ring(const Gizmo& gizmo, int axis) {
  const glm::dvec3 u = gizmo.axes[(axis + 1) % 3], v = gizmo.axes[(axis + 2) % 3];
  const glm::dvec3 to_eye = glm::normalize(gizmo.camera.eye() - gizmo.center);
  const auto point = [&](int i) {
    const double angle = 2 * glm::pi<double>() * i / ring_points;
    return std::cos(angle) * u + std::sin(angle) * v;
  };
  // A ring that is seen from its axis faces the eye all around: the cosines are 0, apart from
  // rounding and a few degrees between its axis and the line of sight.
  const auto faces = [&](int i) { return glm::dot(point(i), to_eye) > -0.1; };
  int first = 0;
  while (first < ring_points && !(faces(first) && !faces(first - 1))) ++first;
  std::vector<glm::dvec3> points;
  for (int i = 0; i <= ring_points && (first == ring_points || faces(first + i)); ++i)
    points.push_back(gizmo.center + gizmo.arm * point(first + i));
  return points;
}

/// Adds the handle unless a part is not in front of the camera.
void add(std::vector<GizmoHandle>& handles, const Gizmo& gizmo, Kind kind, int axis,
         const std::vector<glm::dvec3>& points) {
  GizmoHandle handle{kind, axis, {}};
  for (const glm::dvec3& each : points) {
    const std::optional<glm::dvec2> at = gizmo.project(each);
    if (!at) return;
    handle.shape.push_back(*at);
  }
  handles.push_back(std::move(handle));
}

double distance(const glm::dvec2& point, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 way = b - a;
  const double square = glm::dot(way, way);
  const double part = square > 0 ? std::clamp(glm::dot(point - a, way) / square, 0.0, 1.0) : 0;
  return glm::distance(point, a + part * way);
}

double distance(const glm::dvec2& point, const GizmoHandle& handle) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto& shape = handle.shape;
  for (std::size_t i = 1; i < shape.size(); ++i)
    nearest = std::min(nearest, distance(point, shape[i - 1], shape[i]));
  // The inside of a square.
  if (handle.kind == Kind::plane) nearest = std::min(nearest, distance(point, shape[0], shape[2]));
  return nearest;
}

/// About a fifth of an arm: 1, 2 or 5 times a power of ten.
double move_step(double arm) {
  const double power = std::pow(10, std::floor(std::log10(arm / 5))), part = arm / 5 / power;
  return power * (part >= 5 ? 5 : part >= 2 ? 2 : 1);
}

double snapped(double value, double step, Snapping snapping) {
  return snapping == Snapping::on ? step * std::round(value / step) : value;
}

glm::dmat4 about(const glm::dvec3& center, const glm::dmat4& change) {
  return at_origin(center) * change * at_origin(-center);
}

/// Radians by which the ring turns.
std::optional<double> turn_of(const GizmoDrag& drag, const glm::dvec2& to) {
  const Gizmo& gizmo = drag.gizmo;
  const glm::dvec3 axis = gizmo.axes[drag.handle.axis];
  if (sine_to_plane(gizmo, axis) > round_ring_sine) {
    const auto from_at = in_plane(gizmo, axis, drag.from), to_at = in_plane(gizmo, axis, to);
    if (!from_at || !to_at) return {};
    return std::atan2(glm::dot(axis, glm::cross(*from_at, *to_at)), glm::dot(*from_at, *to_at));
  }
  // By the direction in the image in which the point of the ring under the pointer goes.
  const std::vector<glm::dvec3> points = ring(gizmo, drag.handle.axis);
  // Farther than any point of the image: behind the camera.
  constexpr double far_away = 1e9;
  const auto nearest =
      std::min_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
        const auto away = [&](const glm::dvec3& point) {
          return glm::distance(gizmo.project(point).value_or(glm::dvec2(far_away)), drag.from);
        };
        return away(a) < away(b);
      });
  constexpr double small = 1e-4;  // radians: the chord is the tangent
  const glm::dvec3 tangent = glm::cross(axis, *nearest - gizmo.center);
  const auto at = gizmo.project(*nearest), next = gizmo.project(*nearest + small * tangent);
  if (!at || !next) return {};
  const glm::dvec2 rate = (*next - *at) / small;  // per radian
  return glm::dot(to - drag.from, rate) / glm::dot(rate, rate);
}

std::string axis_letter(int axis) { return std::string(1, char('x' + axis)); }

}  // namespace

std::optional<glm::dvec2> Gizmo::project(const glm::dvec3& point) const {
  const glm::dvec3 in_view(camera.view_from_world * glm::dvec4(point, 1));
  // Nearer than a hundredth of the centre's depth: the shape would be far larger than the image.
  const glm::dvec3 middle(camera.view_from_world * glm::dvec4(center, 1));
  if (!(in_view.z < 0.01 * middle.z)) return {};
  return glm::dvec2(camera.cx - camera.fx * in_view.x / in_view.z,
                    camera.cy + camera.fy * in_view.y / in_view.z);
}

std::vector<GizmoHandle> Gizmo::handles(GizmoTool tool) const {
  std::vector<GizmoHandle> result;
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 axis = axes[i], u = axes[(i + 1) % 3], v = axes[(i + 2) % 3];
    if (tool == GizmoTool::turn) add(result, *this, Kind::ring, i, ring(*this, i));
    if (tool != GizmoTool::move) continue;
    if (sine_to(*this, axis) > least_arrow_sine)
      add(result, *this, Kind::axis, i, {center + arrow_begin * arm * axis, center + arm * axis});
    const auto corner = [&](double a, double b) { return center + arm * (a * u + b * v); };
    if (sine_to_plane(*this, axis) > least_plane_sine)
      add(result, *this, Kind::plane, i,
          {corner(square_low, square_low), corner(square_high, square_low),
           corner(square_high, square_high), corner(square_low, square_high)});
  }
  if (tool == GizmoTool::scale) {
    const glm::dmat3 view = camera.world_from_view_rotation();
    std::vector<glm::dvec3> circle;
    for (int i = 0; i <= ring_points; ++i) {
      const double angle = 2 * glm::pi<double>() * i / ring_points;
      circle.push_back(center + arm * (std::cos(angle) * view[0] + std::sin(angle) * view[1]));
    }
    add(result, *this, Kind::size, 0, circle);
  }
  return result;
}

std::optional<Gizmo> gizmo_of(const LayerPlace& layer, GizmoAxes axes, const Camera& camera,
                              double arm) {
  Gizmo gizmo{.camera = camera};
  gizmo.center = glm::dvec3(layer.world_from_layer * glm::dvec4(layer.bounds.center(), 1));
  const double depth = -(camera.view_from_world * glm::dvec4(gizmo.center, 1)).z;
  if (!(depth > 0)) return {};
  gizmo.arm = arm * depth / camera.fy;
  if (axes == GizmoAxes::layer)
    for (int i = 0; i < 3; ++i)
      gizmo.axes[i] = glm::normalize(glm::dvec3(layer.world_from_layer[i]));
  return gizmo;
}

std::optional<std::size_t> handle_at(const std::vector<GizmoHandle>& handles,
                                     const glm::dvec2& point, double reach) {
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const double away = distance(point, handles[i]);
    if (away > reach) continue;
    nearest = i;
    reach = away;
  }
  return nearest;
}

std::optional<GizmoChange> change_of(const GizmoDrag& drag, const glm::dvec2& to,
                                     Snapping snapping) {
  const Gizmo& gizmo = drag.gizmo;
  const glm::dvec3 axis = gizmo.axes[drag.handle.axis];
  glm::dmat4 change(1.0);
  std::string text;
  switch (drag.handle.kind) {
    case Kind::axis: {
      const auto begin = along(gizmo, axis, drag.from), end = along(gizmo, axis, to);
      if (!begin || !end) return {};
      const double way = snapped(*end - *begin, move_step(gizmo.arm), snapping);
      change = at_origin(way * axis);
      text = fmt::format("{} {:.4g}", axis_letter(drag.handle.axis), way);
      break;
    }
    case Kind::plane: {
      const auto begin = in_plane(gizmo, axis, drag.from), end = in_plane(gizmo, axis, to);
      if (!begin || !end) return {};
      for (const int i : {(drag.handle.axis + 1) % 3, (drag.handle.axis + 2) % 3}) {
        const double way =
            snapped(glm::dot(*end - *begin, gizmo.axes[i]), move_step(gizmo.arm), snapping);
        change = at_origin(way * gizmo.axes[i]) * change;
        text += fmt::format("{}{} {:.4g}", text.empty() ? "" : ", ", axis_letter(i), way);
      }
      break;
    }
    case Kind::ring: {
      const auto turn = turn_of(drag, to);
      if (!turn) return {};
      const double degrees = snapped(*turn * degrees_per_radian, snapped_degrees, snapping);
      change =
          about(gizmo.center, glm::rotate(glm::dmat4(1.0), degrees / degrees_per_radian, axis));
      text = fmt::format("{:.4g}\u00b0", degrees);
      break;
    }
    case Kind::size: {
      const auto middle = gizmo.project(gizmo.center);
      if (!middle) return {};
      const double ratio = glm::distance(to, *middle) / glm::distance(drag.from, *middle);
      const double low = snapping == Snapping::on ? snapped_factor : least_factor;
      const double factor = std::clamp(snapped(ratio, snapped_factor, snapping), low, most_factor);
      change = about(gizmo.center, glm::scale(glm::dmat4(1.0), glm::dvec3(factor)));
      text = fmt::format("\u00d7 {:.4g}", factor);
      break;
    }
  }
  if (to == drag.from) return GizmoChange{drag.world_from_layer, text};
  const glm::dmat4 placed = change * drag.world_from_layer;
  if (defect(Layer{.world_from_layer = placed})) return {};  // numbers that are too large
  // Through its numbers, so that rounding errors of many drags do not add up to a shear.
  return GizmoChange{matrix_of(similarity_of(placed)), text};
}

}  // namespace tureen::viewer
