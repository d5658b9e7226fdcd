// What a color MLP has to learn: how the room mirrors itself in glaze, by direction.
#pragma once

#include <glm/vec3.hpp>

namespace tureen::example {

/// The displayed colour of a glossy surface of the given diffuse radiance, seen from `to_eye`.
/// gloss in [0, 1] scales the mirror; Fresnel's factor by Schlick's approximation.
glm::dvec3 glazed(glm::dvec3 diffuse, double gloss, glm::dvec3 normal, glm::dvec3 to_eye);

}  // namespace tureen::example
