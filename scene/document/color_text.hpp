// Colours as people write them.
#pragma once

#include <glm/vec3.hpp>
#include <string>

namespace tureen {

/// A colour of CSS by its name (https://www.w3.org/TR/css-color-4/#named-colors), "#rrggbb" with or
/// without "#", or "r,g,b" with each from 0 to 1. Throws UsageError with the expected form.
glm::vec3 parse_color(const std::string& text);

/// "#RRGGBB", each channel rounded.
std::string color_text(const glm::vec3& color);

}  // namespace tureen
