// One texture sample in double precision, by GL's rules without mip levels (OpenGL ES 3.0, sections
// 3.8.9 and 3.8.10). (0, 0) is the top left corner of the image's first row.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "scene/triangle_soup.hpp"

namespace tureen::oracle {

/// Channels in [0, 1]. Non-finite coordinates sample at 0.
glm::dvec4 sample(const Image8& image, const UvMaterial& material, glm::dvec2 uv);

}  // namespace tureen::oracle
