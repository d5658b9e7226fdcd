// The intersection of a pixel's ray with a triangle, in double precision, by solving for the point;
// and triangles of every kind. Shares only the types with kernels/projection.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "tests/support/random.hpp"
#include "trainer/common/kernels/projection.hpp"

namespace tureen::trainer::test {

using tureen::test::Random;

/// The plane's point on the ray through (x + 1/2, y + 1/2).
struct RayHit {
  double e[3];           // barycentrics over the depth
  double inverse_depth;  // their sum
  double slope[3];       // approximate change of e from one pixel to the next
};

inline glm::dvec3 ray(const kernels::View& view, double x, double y) {
  const double u = (x + 0.5 - view.cx) / view.fx, v = (y + 0.5 - view.cy) / view.fy;
  glm::dvec3 d;
  for (int i = 0; i < 3; ++i) d[i] = u * view.right[i] + v * view.down[i] + view.forward[i];
  return d;  // of depth 1
}

/// Barycentrics b and depth w solve b0 A + b1 B + b2 C = w d with sum b = 1. Thus e = b / w solves
/// [A B C] e = d, with corners relative to the eye.
inline std::array<double, 3> solve(const kernels::View& view, const float* corners, double x,
                                   double y) {
  glm::dmat3 m;
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) m[k][i] = double(corners[3 * k + i]) - view.eye[i];
  const glm::dvec3 d = ray(view, x, y);
  const double volume = glm::dot(m[0], glm::cross(m[1], m[2]));
  return {glm::dot(d, glm::cross(m[1], m[2])) / volume,
          glm::dot(d, glm::cross(m[2], m[0])) / volume,
          glm::dot(d, glm::cross(m[0], m[1])) / volume};
}

inline RayHit intersect(const kernels::View& view, const float* corners, int x, int y) {
  const auto e = solve(view, corners, x, y);
  const auto right = solve(view, corners, x + 1, y), down = solve(view, corners, x, y + 1);
  RayHit hit;
  hit.inverse_depth = e[0] + e[1] + e[2];
  for (std::size_t k = 0; k < 3; ++k) {
    hit.e[k] = e[k];
    hit.slope[k] = std::abs(right[k] - e[k]) + std::abs(down[k] - e[k]);
  }
  return hit;
}

inline bool hits(const RayHit& hit, const kernels::View& view) {
  return hit.e[0] >= 0 && hit.e[1] >= 0 && hit.e[2] >= 0 && hit.inverse_depth >= 1 / view.far &&
         hit.inverse_depth <= 1 / view.near;
}

/// Largest error of float edge functions at a pixel. Coefficients and the two sums are rounded:
/// five times half a unit in the last place of the terms. In double precision, products that cancel
/// for thin needles have errors of 2^-53; 2^-40 covers aspects of 1e4.
inline std::array<double, 3> rounding_bounds(const kernels::ProjectedFace& face, int x, int y) {
  std::array<double, 3> bounds;
  for (int k = 0; k < 3; ++k)
    bounds[std::size_t(k)] =
        (5 * 0x1p-24 + 0x1p-40) *
        (std::abs(double(face.c[k])) + std::abs(double(face.dx[k])) * std::abs(x - face.x0) +
         std::abs(double(face.dy[k])) * std::abs(y - face.y0));
  return bounds;
}

/// At the origin, along +z, y down: view coordinates are world coordinates.
inline kernels::View plain_view(int width, int height) {
  return {.width = width,
          .height = height,
          .fx = 50,
          .fy = 50,
          .cx = width / 2.0,
          .cy = height / 2.0,
          .eye = {0, 0, 0},
          .right = {1, 0, 0},
          .down = {0, 1, 0},
          .forward = {0, 0, 1},
          .near = 0.01,
          .far = 100};
}

/// Random position and rotation, unequal focal lengths, the principal point far from the middle.
inline kernels::View random_view(Random& random, int width, int height) {
  kernels::View view = plain_view(width, height);
  view.fx = random.uniform(20, 100);
  view.fy = random.uniform(20, 100);
  view.cx = random.uniform(-0.5, 1.5) * width;
  view.cy = random.uniform(-0.5, 1.5) * height;
  view.near = 0.05;
  const glm::dvec3 forward = random.direction();
  const glm::dvec3 right = glm::normalize(glm::cross(forward, random.direction()));
  const glm::dvec3 down = glm::cross(forward, right);
  for (int i = 0; i < 3; ++i) {
    view.eye[i] = random.uniform(-3, 3);
    view.right[i] = right[i];
    view.down[i] = down[i];
    view.forward[i] = forward[i];
  }
  return view;
}

enum class TriangleKind { ordinary, large, crossing_near, behind, needle, tiny, far_outside };
inline constexpr TriangleKind triangle_kinds[] = {
    TriangleKind::ordinary, TriangleKind::large, TriangleKind::crossing_near, TriangleKind::behind,
    TriangleKind::needle,   TriangleKind::tiny,  TriangleKind::far_outside};

inline std::string name(TriangleKind kind) {
  switch (kind) {
    case TriangleKind::ordinary:
      return "OrdinaryTriangles";
    case TriangleKind::large:
      return "LargeTriangles";
    case TriangleKind::crossing_near:
      return "TrianglesThroughTheNearPlane";
    case TriangleKind::behind:
      return "TrianglesBehindTheEye";
    case TriangleKind::needle:
      return "Needles";
    case TriangleKind::tiny:
      return "TrianglesOfAboutAPixel";
    case TriangleKind::far_outside:
      return "TrianglesFarOutside";
  }
  return {};
}

/// Whether some pixels show triangles of this kind.
inline bool is_drawn(TriangleKind kind) {
  return kind != TriangleKind::behind && kind != TriangleKind::far_outside;
}

inline void random_triangle(Random& random, const kernels::View& view, TriangleKind kind,
                            float (&corners)[9]) {
  // Around a point in the image.
  const double px = random.uniform(0, view.width), py = random.uniform(0, view.height);
  const double depth = random.uniform(1, 5), pixel = depth / view.fx;
  glm::dvec3 eye(view.eye[0], view.eye[1], view.eye[2]);
  glm::dvec3 middle = eye + depth * ray(view, px, py);
  double radius = 15 * pixel;
  if (kind == TriangleKind::large) radius = 3;
  if (kind == TriangleKind::tiny) radius = pixel;
  if (kind == TriangleKind::far_outside) middle = eye + depth * ray(view, px + 1000, py);
  const glm::dvec3 forward(view.forward[0], view.forward[1], view.forward[2]);
  const glm::dvec3 along = random.direction();
  for (int k = 0; k < 3; ++k) {
    glm::dvec3 p = middle + radius * random.direction();
    if (kind == TriangleKind::needle)
      p = middle + along * random.uniform(-1, 1) + 0.1 * pixel * random.direction();
    if (kind == TriangleKind::crossing_near && k == 0)
      p -= forward * (glm::dot(p - eye, forward) + random.uniform(-0.05, 3));
    if (kind == TriangleKind::behind)
      p -= forward * (glm::dot(p - eye, forward) + random.uniform(-0.04, 3));
    for (int i = 0; i < 3; ++i) corners[3 * k + i] = float(p[i]);
  }
}

}  // namespace tureen::trainer::test
