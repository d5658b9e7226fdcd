#include "tracing/kernels/face_on_ray.hpp"

#include <glm/common.hpp>
#include <glm/vec2.hpp>

namespace tureen::tracing {

// Woop, Benthin and Wald, Watertight Ray/Triangle Intersection (2013): the corners are projected
// along the ray onto the plane of two axes, where all faces at a corner have the same point.
FaceOnRay face_on_ray(const TriangleSoup& soup, std::uint32_t face, const RayInLayer& ray) {
  const glm::uvec3& t = soup.triangles[face];
  glm::dvec3 v[3];
  for (int k = 0; k < 3; ++k) v[k] = glm::dvec3(soup.positions[t[k]]) - ray.origin;
  const glm::dvec3 size = glm::abs(ray.direction);
  const int along = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int first = (along + 1) % 3, second = (along + 2) % 3;
  glm::dvec2 p[3];
  for (int k = 0; k < 3; ++k) {
    const double depth = v[k][along] / ray.direction[along];
    p[k] = {v[k][first] - depth * ray.direction[first],
            v[k][second] - depth * ray.direction[second]};
  }
  double e[3];
  for (int k = 0; k < 3; ++k) {
    const glm::dvec2 &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
    e[k] = a.x * b.y - a.y * b.x;
  }
  const bool inside =
      (e[0] >= 0 && e[1] >= 0 && e[2] >= 0) || (e[0] <= 0 && e[1] <= 0 && e[2] <= 0);
  const double sum = e[0] + e[1] + e[2];
  const double distance =
      (e[0] * v[0][along] + e[1] * v[1][along] + e[2] * v[2][along]) / (sum * ray.direction[along]);
  return {distance, e[0] / sum, e[1] / sum, inside && sum != 0 && distance > ray.least};
}

}  // namespace tureen::tracing
