// What glaze adds to the colour below it: a mirror that grows stronger at grazing angles.
#pragma once

#include <glm/vec3.hpp>

namespace tureen::example {

/// The displayed colour of a glossy surface of the given diffuse radiance. gloss in [0, 1] scales
/// the mirror, whose radiance is `mirrored`; `cosine` is that between the normal and the
/// direction to the eye. Fresnel's factor by Schlick's approximation.
glm::dvec3 glazed(glm::dvec3 diffuse, double gloss, double cosine, glm::dvec3 mirrored);

}  // namespace tureen::example
