// Converts texts to the values of options. All functions throw UsageError with the expected form or
// range.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>

namespace tureen::cli {

struct ImageSize {
  int width = 0;
  int height = 0;
};

/// "1280x720"; at most max_image_pixels pixels.
ImageSize parse_size(const std::string& text);

/// The same for images that are never completely in memory; only the sides have a limit.
ImageSize parse_any_size(const std::string& text);

/// "1,-2.5,3e2"; finite.
glm::dvec3 parse_vector(const std::string& text);

/// The same, or an axis: "z", "-y".
glm::dvec3 parse_direction(const std::string& text);

/// parse_color() (scene/document/color_text.hpp), or "transparent": black with alpha 0.
glm::vec4 parse_background(const std::string& text);

/// A whole number from `low` to `high`.
int parse_integer(const std::string& text, int low, int high);

}  // namespace tureen::cli
