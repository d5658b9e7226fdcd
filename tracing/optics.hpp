// Light at smooth surfaces.
#pragma once

#include <glm/vec3.hpp>

namespace tureen::tracing {

/// What leaves a surface, of light that comes against `direction` of a ray. Directions are of unit
/// length.
struct Splitting {
  glm::dvec3 reflected{0}, refracted{0};
  double reflectance = 1;  // [0, 1]; 1: total internal reflection, and nothing is refracted
};

/// `normal`, of unit length, points to the side that the ray comes from.
glm::dvec3 reflection(const glm::dvec3& direction, const glm::dvec3& normal);

/// At the boundary between the refractive indices n1, where the ray comes from, and n2: Snell's law
/// and Fresnel's equations for unpolarised light.
Splitting at_boundary(const glm::dvec3& direction, const glm::dvec3& normal, double n1, double n2);

}  // namespace tureen::tracing
