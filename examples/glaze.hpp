// Glaze over a colour: a mirror that is stronger at grazing angles.
#pragma once

#include <glm/vec3.hpp>

namespace tureen::example {

/// The displayed colour of a glossy surface with the given diffuse radiance. `gloss` in [0, 1]
/// scales the mirror, `mirrored` is its radiance. `cosine` is the cosine of the angle between the
/// normal and the direction to the eye. The Fresnel factor uses Schlick's approximation.
glm::dvec3 glazed(glm::dvec3 diffuse, double gloss, double cosine, glm::dvec3 mirrored);

}  // namespace tureen::example
