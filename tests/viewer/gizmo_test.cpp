// The gizmo's mathematics: a pointer that follows a point of a handle moves the layer with it.
#include "viewer/scene/gizmo.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "scene/similarity.hpp"
#include "tests/support/random_soups.hpp"
#include "viewer/scene/placing.hpp"

namespace tureen::viewer {
namespace gizmo_test {

using Kind = GizmoHandle::Kind;
using test::Random;

/// Coordinates are of the order of 10 and go through a dozen operations in double precision.
constexpr double rounding = 1e-10;

struct Case {
  Gizmo gizmo;
  glm::dmat4 place;
};

/// A layer anywhere, turned and mirrored, seen from anywhere.
Case random_case(Random& random, GizmoAxes axes) {
  const auto number = [&] { return double(random.uniform(-1, 1)); };
  const auto vector = [&] { return glm::dvec3(number(), number(), number()); };
  LayerPlace layer;
  layer.bounds = {glm::vec3(-1), glm::vec3(2)};
  layer.world_from_layer = matrix_of(
      {.position = 5.0 * vector(), .angles = 80.0 * vector(), .scale = 1.5, .mirror = true});
  const glm::dvec3 eye = 20.0 * glm::normalize(vector() + glm::dvec3(0.1, 0.2, 0.3));
  const auto gizmo = gizmo_of(layer, axes, look_at(eye, {0, 0, 0}, {0, 1, 0}, 0.8, 800, 600), 80);
  EXPECT_TRUE(gizmo);
  return {*gizmo, layer.world_from_layer};
}

const GizmoHandle* find(const std::vector<GizmoHandle>& handles, Kind kind, int axis) {
  for (const GizmoHandle& each : handles)
    if (each.kind == kind && each.axis == axis) return &each;
  return nullptr;
}

double difference(const glm::dmat4& a, const glm::dmat4& b) {
  double most = 0;
  for (int i = 0; i < 4; ++i) most = std::max(most, glm::length(a[i] - b[i]));
  return most;
}

TEST(Gizmo, MovesWithThePointer) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto [gizmo, place] = random_case(random, seed % 2 ? GizmoAxes::world : GizmoAxes::layer);
    for (const GizmoHandle& handle : gizmo.handles(GizmoTool::move)) {
      const glm::dvec3 axis = gizmo.axes[handle.axis];
      const glm::dvec3 way = handle.kind == Kind::axis
                                 ? 0.7 * gizmo.arm * axis
                                 : gizmo.arm * (0.4 * gizmo.axes[(handle.axis + 1) % 3] -
                                                0.3 * gizmo.axes[(handle.axis + 2) % 3]);
      const auto change = change_of({gizmo, handle, *gizmo.project(gizmo.center), place},
                                    *gizmo.project(gizmo.center + way), Snapping::off);
      ASSERT_TRUE(change);
      EXPECT_LT(difference(change->world_from_layer, at_origin(way) * place), rounding);
    }
  }
}

TEST(Gizmo, TurnsAndScalesAboutTheMiddle) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const auto [gizmo, place] = random_case(random, seed % 2 ? GizmoAxes::world : GizmoAxes::layer);
    const auto about = [&, center = gizmo.center](const glm::dmat4& change) {
      return at_origin(center) * change * at_origin(-center);
    };
    const auto handles = gizmo.handles(GizmoTool::turn);
    ASSERT_EQ(handles.size(), 3u) << "every ring can be dragged";
    for (const GizmoHandle& handle : handles) {
      const int i = handle.axis;
      const glm::dvec3 axis = gizmo.axes[i];
      const auto on_ring = [&](double angle) {
        return gizmo.center + gizmo.arm * (std::cos(angle) * gizmo.axes[(i + 1) % 3] +
                                           std::sin(angle) * gizmo.axes[(i + 2) % 3]);
      };
      // Shapes have points at 64ths of a turn.
      const glm::dvec2 from = handle.shape[handle.shape.size() / 2];
      double angle_of_press = 0, nearest = 1e9;
      for (int k = 0; k < 64; ++k) {
        const double angle = 2 * glm::pi<double>() * k / 64;
        const double away = glm::distance(*gizmo.project(on_ring(angle)), from);
        if (away >= nearest) continue;
        nearest = away;
        angle_of_press = angle;
      }
      ASSERT_LT(nearest, 1e-9);
      const bool is_round =
          std::abs(glm::dot(axis, glm::normalize(gizmo.center - gizmo.camera.eye()))) > 0.4;
      // A narrow ring turns by the way along its tangent: that differs from the angle by its
      // square.
      const double angle = is_round ? 0.5 : 1e-3;
      const auto change = change_of({gizmo, handle, from, place},
                                    *gizmo.project(on_ring(angle_of_press + angle)), Snapping::off);
      ASSERT_TRUE(change);
      // The axes of a mirrored layer are left-handed: from u to v is the other way about the axis.
      const double sign = glm::determinant(gizmo.axes) < 0 ? -1 : 1;
      const glm::dmat4 expected = about(glm::rotate(glm::dmat4(1.0), sign * angle, axis)) * place;
      EXPECT_LT(difference(change->world_from_layer, expected), is_round ? 1e-8 : 1e-4);
    }
    const std::vector<GizmoHandle> circle = gizmo.handles(GizmoTool::scale);
    ASSERT_EQ(circle.size(), 1u);
    const glm::dvec2 middle = *gizmo.project(gizmo.center), from = circle[0].shape[7];
    const auto change =
        change_of({gizmo, circle[0], from, place}, middle + 1.5 * (from - middle), Snapping::off);
    ASSERT_TRUE(change);
    const glm::dmat4 expected = about(glm::scale(glm::dmat4(1.0), glm::dvec3(1.5))) * place;
    EXPECT_LT(difference(change->world_from_layer, expected), rounding);
    EXPECT_LT(glm::determinant(glm::dmat3(change->world_from_layer)), 0) << "still mirrored";
  }
}

TEST(Gizmo, SnapsToRoundSteps) {
  const Camera camera = look_at({3, 4, 10}, {0, 0, 0}, {0, 1, 0}, 0.8, 800, 600);
  LayerPlace layer;
  layer.bounds = {glm::vec3(-1), glm::vec3(1)};
  const Gizmo gizmo = *gizmo_of(layer, GizmoAxes::world, camera, 80);
  const auto drag = [&](GizmoTool tool, Kind kind, int axis, const glm::dvec2& by) {
    const auto handles = gizmo.handles(tool);
    const GizmoHandle& handle = *find(handles, kind, axis);
    const glm::dvec2 from = handle.shape.back();
    return similarity_of(change_of({gizmo, handle, from, glm::dmat4(1.0)}, from + by, Snapping::on)
                             ->world_from_layer);
  };
  // An arm is about 1.3 units long: a step is 0.2.
  const double x = drag(GizmoTool::move, Kind::axis, 0, {33, 5}).position.x;
  EXPECT_GT(x, 0.1);
  EXPECT_NEAR(x / 0.2, std::round(x / 0.2), 1e-9);
  const double angle = drag(GizmoTool::turn, Kind::ring, 1, {-37, 3}).angles.y;
  EXPECT_NE(angle, 0);
  EXPECT_NEAR(angle / 15, std::round(angle / 15), 1e-9);
  EXPECT_NEAR(drag(GizmoTool::scale, Kind::size, 0, {43, 0}).scale, 1.5, 1e-9);
  // A press alone changes nothing, not even a last digit.
  const auto handles = gizmo.handles(GizmoTool::turn);
  const glm::dmat4 place = matrix_of({.position = {1, 2, 3}, .angles = {10, 20, 30}});
  const glm::dvec2 at = handles[0].shape[0];
  EXPECT_EQ(change_of({gizmo, handles[0], at, place}, at, Snapping::off)->world_from_layer, place);
}

TEST(Gizmo, FindsTheHandleUnderThePointer) {
  const Camera camera = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 0.8, 800, 600);
  const LayerPlace layer;
  const Gizmo gizmo = *gizmo_of(layer, GizmoAxes::world, camera, 80);
  const auto handles = gizmo.handles(GizmoTool::move);
  // z points at the eye, and the planes across x and y are seen from their edges.
  EXPECT_EQ(handles.size(), 3u);
  const auto found = [&](const glm::dvec2& at) -> const GizmoHandle* {
    const auto index = handle_at(handles, at, 8);
    return index ? &handles[*index] : nullptr;
  };
  EXPECT_EQ(found({470, 303}), find(handles, Kind::axis, 0));
  EXPECT_EQ(found({398, 240}), find(handles, Kind::axis, 1));
  EXPECT_EQ(found({438, 262}), find(handles, Kind::plane, 2));
  EXPECT_EQ(found({340, 340}), nullptr);
  EXPECT_FALSE(
      gizmo_of(layer, GizmoAxes::world, look_at({0, 0, 10}, {0, 0, 20}, {0, 1, 0}, 0.8, 8, 6), 80))
      << "behind the camera";
}

TEST(Placing, OnTheGroundAndInTheMiddle) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    DocumentLayer layer;
    layer.primitives = std::make_shared<const Primitives>(test::random_soup(seed, {.faces = 50}));
    const TriangleSoup& soup = *soup_of(layer);
    layer.bounds = bounds(soup);
    layer.world_from_layer =
        matrix_of({.position = {1, -2, 3}, .angles = {20.0 * double(seed), 30, 40}, .scale = 2});
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.2, 1, -0.3));
    const glm::dmat4 placed = on_the_ground(layer, up);
    double lowest = 1e9;
    for (const glm::uvec3& corners : soup.triangles)
      for (int k = 0; k < 3; ++k)
        lowest = std::min(
            lowest,
            glm::dot(up,
                     glm::dvec3(placed * glm::dvec4(glm::dvec3(soup.positions[corners[k]]), 1))));
    EXPECT_NEAR(lowest, 0, rounding);
    EXPECT_LT(glm::length(glm::cross(glm::dvec3(placed[3] - layer.world_from_layer[3]), up)),
              rounding)
        << "only along the up axis";
    const glm::dvec3 middle(in_the_middle(layer) * glm::dvec4(layer.bounds.center(), 1));
    EXPECT_LT(glm::length(middle), rounding);
  }
}

}  // namespace gizmo_test
}  // namespace tureen::viewer
