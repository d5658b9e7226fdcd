#include "glaze.hpp"

#include <cmath>
#include <glm/geometric.hpp>

#include "light.hpp"

namespace tureen::example {

glm::dvec3 glazed(glm::dvec3 diffuse, double gloss, glm::dvec3 normal, glm::dvec3 to_eye) {
  const double cosine = std::max(0.0, glm::dot(normal, to_eye));
  const double fresnel = 0.05 + 0.55 * std::pow(1 - cosine, 5.0);
  const glm::dvec3 mirrored = 2 * cosine * normal - to_eye;
  const double weight = fresnel * std::min(1.0, gloss / 0.6);
  return displayed((1 - weight) * diffuse + weight * room_radiance(mirrored));
}

}  // namespace tureen::example
