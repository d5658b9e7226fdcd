#include "cli/options/values.hpp"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "base/error.hpp"
#include "image/png.hpp"
#include "scene/document/color_text.hpp"

namespace tureen::cli {

namespace {

/// Three finite numbers, separated by commas.
std::optional<glm::dvec3> three_numbers(const std::string& text) {
  glm::dvec3 result;
  const char* at = text.c_str();
  for (int i = 0; i < 3; ++i) {
    char* end = nullptr;
    result[i] = std::strtod(at, &end);
    if (end == at || !std::isfinite(result[i]) || *end != (i < 2 ? ',' : '\0')) return {};
    at = end + 1;
  }
  return result;
}

std::optional<int> whole_number(const std::string& text, int low, int high) {
  char* end = nullptr;
  errno = 0;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end || errno || value < low || value > high) return {};
  return int(value);
}

}  // namespace

ImageSize parse_any_size(const std::string& text) {
  const std::size_t times = text.find('x');
  std::optional<int> width, height;
  if (times != std::string::npos) {
    width = whole_number(text.substr(0, times), 1, max_image_side);
    height = whole_number(text.substr(times + 1), 1, max_image_side);
  }
  if (!width || !height)
    throw UsageError("'" + text + "' is not a size",
                     "write it as 1280x720, each side from 1 to " + std::to_string(max_image_side));
  return {*width, *height};
}

ImageSize parse_size(const std::string& text) {
  const ImageSize size = parse_any_size(text);
  if (std::size_t(size.width) * std::size_t(size.height) > max_image_pixels)
    throw UsageError("an image of " + text + " has more than " + std::to_string(max_image_pixels) +
                     " pixels");
  return size;
}

glm::dvec3 parse_vector(const std::string& text) {
  if (const auto vector = three_numbers(text)) return *vector;
  throw UsageError("'" + text + "' is not a vector", "write it as 1,-2.5,3");
}

glm::dvec3 parse_direction(const std::string& text) {
  const bool is_negative = text.starts_with('-');
  const std::string axis = text.substr(is_negative || text.starts_with('+') ? 1 : 0);
  if (axis.size() != 1 || axis < "x" || axis > "z") {
    if (const auto vector = three_numbers(text)) return *vector;
    throw UsageError("'" + text + "' is not a direction",
                     "write an axis such as z or -y, or 0,0,1");
  }
  glm::dvec3 direction(0.0);
  direction[axis[0] - 'x'] = is_negative ? -1 : 1;
  return direction;
}

glm::vec4 parse_background(const std::string& text) {
  if (text == "transparent") return glm::vec4(0);
  try {
    return {parse_color(text), 1};
  } catch (const UsageError& error) {
    throw UsageError(error.reason(), "write transparent, white, #ff8000, or 0.2,0.4,1");
  }
}

int parse_integer(const std::string& text, int low, int high) {
  if (const auto value = whole_number(text, low, high)) return *value;
  throw UsageError("'" + text + "' is not a whole number from " + std::to_string(low) + " to " +
                   std::to_string(high));
}

}  // namespace tureen::cli
