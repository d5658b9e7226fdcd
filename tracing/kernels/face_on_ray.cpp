#include "tracing/kernels/face_on_ray.hpp"

#include <glm/geometric.hpp>

namespace tureen::tracing {

// b_k = E_k / (E_0 + E_1 + E_2) with E_k = d . (v_i x v_j), from the
// origin of the ray.
FaceOnRay face_on_ray(const TriangleSoup& soup, std::uint32_t face, const RayInLayer& ray) {
  const glm::uvec3& t = soup.triangles[face];
  glm::dvec3 v[3];
  for (int k = 0; k < 3; ++k) v[k] = glm::dvec3(soup.positions[t[k]]) - ray.origin;
  double e[3];
  for (int k = 0; k < 3; ++k)
    e[k] = glm::dot(ray.direction, glm::cross(v[(k + 1) % 3], v[(k + 2) % 3]));
  const bool inside =
      (e[0] >= 0 && e[1] >= 0 && e[2] >= 0) || (e[0] <= 0 && e[1] <= 0 && e[2] <= 0);
  const double sum = e[0] + e[1] + e[2];
  const glm::dvec3 normal = glm::cross(v[1] - v[0], v[2] - v[0]);
  const double distance = glm::dot(v[0], normal) / glm::dot(ray.direction, normal);
  return {distance, e[0] / sum, e[1] / sum, inside && sum != 0 && distance > ray.least};
}

}  // namespace tureen::tracing
