#include "tests/support/random.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace tureen::test {

double Random::uniform() { return double(engine_() >> 11) * 0x1p-53; }

double Random::uniform(double low, double high) { return low + (high - low) * uniform(); }

std::uint32_t Random::below(std::uint32_t count) { return std::uint32_t(uniform() * count); }

bool Random::chance(double probability) { return uniform() < probability; }

double Random::normal() {
  // Box and Muller (1958). 1 - uniform() is never 0.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(glm::two_pi<double>() * uniform());
}

glm::dvec3 Random::direction() {
  // Archimedes: the height of points on a sphere is uniform.
  const double z = uniform(-1.0, 1.0);
  const double angle = glm::two_pi<double>() * uniform();
  const double radius = std::sqrt(1.0 - z * z);
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

}  // namespace tureen::test
