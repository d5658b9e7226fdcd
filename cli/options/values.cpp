#include "cli/options/values.hpp"

#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <glm/common.hpp>
#include <optional>

#include "base/error.hpp"
#include "image/png.hpp"

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

/// The basic colours of CSS, and some that people name (https://www.w3.org/TR/css-color-4).
struct NamedColor {
  const char* name;
  std::uint32_t rgb;
};
constexpr NamedColor named_colors[] = {
    {"aqua", 0x00ffff},      {"beige", 0xf5f5dc}, {"black", 0x000000},     {"blue", 0x0000ff},
    {"brown", 0xa52a2a},     {"cyan", 0x00ffff},  {"darkgray", 0xa9a9a9},  {"darkgrey", 0xa9a9a9},
    {"fuchsia", 0xff00ff},   {"gold", 0xffd700},  {"gray", 0x808080},      {"green", 0x008000},
    {"grey", 0x808080},      {"ivory", 0xfffff0}, {"lightblue", 0xadd8e6}, {"lightgray", 0xd3d3d3},
    {"lightgrey", 0xd3d3d3}, {"lime", 0x00ff00},  {"magenta", 0xff00ff},   {"maroon", 0x800000},
    {"navy", 0x000080},      {"olive", 0x808000}, {"orange", 0xffa500},    {"pink", 0xffc0cb},
    {"purple", 0x800080},    {"red", 0xff0000},   {"silver", 0xc0c0c0},    {"skyblue", 0x87ceeb},
    {"teal", 0x008080},      {"white", 0xffffff}, {"yellow", 0xffff00}};

glm::vec4 color_of(std::uint32_t rgb) {
  return {glm::vec3(rgb >> 16 & 255, rgb >> 8 & 255, rgb & 255) / 255.0f, 1};
}

/// The number of "#rrggbb".
std::optional<std::uint32_t> hexadecimal(const std::string& text) {
  if (text.size() != 7 || text[0] != '#' ||
      text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
    return {};
  return std::uint32_t(std::strtoul(text.c_str() + 1, nullptr, 16));
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
  for (const NamedColor& named : named_colors)
    if (text == named.name) return color_of(named.rgb);
  if (const auto rgb = hexadecimal(text)) return color_of(*rgb);
  const auto color = three_numbers(text);
  if (!color || *color != glm::clamp(*color, 0.0, 1.0))
    throw UsageError("'" + text + "' is not a background",
                     "write a name such as white, #ff8000, transparent or 0.2,0.4,1");
  return {glm::vec3(*color), 1};
}

int parse_integer(const std::string& text, int low, int high) {
  if (const auto value = whole_number(text, low, high)) return *value;
  throw UsageError("'" + text + "' is not a whole number from " + std::to_string(low) + " to " +
                   std::to_string(high));
}

}  // namespace tureen::cli
