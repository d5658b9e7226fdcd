#include "examples/glaze.hpp"

#include <algorithm>
#include <cmath>

#include "examples/light.hpp"

namespace tureen::example {

glm::dvec3 glazed(glm::dvec3 diffuse, double gloss, double cosine, glm::dvec3 mirrored) {
  const double fresnel = 0.05 + 0.55 * std::pow(1 - std::max(0.0, cosine), 5.0);
  const double weight = fresnel * std::min(1.0, gloss / 0.6);
  return displayed((1 - weight) * diffuse + weight * mirrored);
}

}  // namespace tureen::example
