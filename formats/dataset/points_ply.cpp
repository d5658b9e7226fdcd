#include "formats/dataset/points_ply.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "formats/ply/ply_header.hpp"
#include "formats/ply/ply_values.hpp"
#include "formats/read_options.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

constexpr int skipped_property = -1;

/// The names under which programs store a colour. The first group that a file has counts.
struct ColorNames {
  std::array<const char*, 3> names;
  bool are_harmonics = false;  // the coefficients of degree 0 of a file of splats
};
constexpr ColorNames color_names[] = {{{"red", "green", "blue"}},
                                      {{"diffuse_red", "diffuse_green", "diffuse_blue"}},
                                      {{"r", "g", "b"}},
                                      {{"f_dc_0", "f_dc_1", "f_dc_2"}, true}};

/// The columns of a file: slots 0 to 2 are the position, 3 to 5 the colour.
struct PointColumns {
  std::vector<int> slots;  // of each property, or skipped_property
  bool has_colors = false, are_harmonics = false;
  bool are_floats = false;
};

PointColumns columns_of(const PlyElement& vertex, const std::string& file) {
  const auto fail = [&](const std::string& reason) {
    throw InputError({file, {}, vertex.line}, reason);
  };
  PointColumns columns{.slots = std::vector<int>(vertex.properties.size(), skipped_property)};
  const auto take = [&](const std::string& name, int slot) {
    const std::optional<std::size_t> found = vertex.find(name);
    if (!found) return false;
    if (vertex.properties[*found].count_type) fail("the property '" + name + "' is a list");
    columns.slots[*found] = slot;
    return true;
  };
  for (int axis = 0; axis < 3; ++axis)
    if (const std::string name(1, "xyz"[axis]); !take(name, axis))
      fail("the element 'vertex' has no property '" + name + "'");
  for (const ColorNames& group : color_names) {
    if (!std::ranges::all_of(group.names,
                             [&](auto* name) { return vertex.find(name).has_value(); }))
      continue;
    for (int channel = 0; channel < 3; ++channel)
      take(group.names[std::size_t(channel)], 3 + channel);
    const PlyType type = vertex.properties[*vertex.find(group.names[0])].type;
    columns.has_colors = true;
    columns.are_harmonics = group.are_harmonics;
    columns.are_floats = !is_integer(type);
    break;
  }
  return columns;
}

struct RawPoint {
  glm::dvec3 position;
  glm::vec3 color;
};

/// The value of a full channel, by the largest one: 1 is that of floats, 255 of bytes.
double full_channel(const std::vector<RawPoint>& points, bool are_floats) {
  float most = 0;
  for (const RawPoint& point : points)
    most = std::max({most, point.color.r, point.color.g, point.color.b});
  if (are_floats && most <= 1) return 1;
  return most <= 255 ? 255 : 65535;
}

/// The channel of degree-0 harmonics, as 3DGS stores them.
double channel_of_harmonic(float coefficient) { return 0.5 + harmonics::y00 * coefficient; }

}  // namespace

PointsPly read_points_ply(Input& input) {
  const PlyHeader header = read_ply_header(input);
  const PlyElement* vertex = header.find("vertex");
  if (!vertex)
    throw InputError({input.name(), {}, header.body_line - 1}, "has no element 'vertex'");
  PointColumns columns = columns_of(*vertex, input.name());
  const ReadOptions options;
  PlyValues values(input, header, options);
  std::vector<RawPoint> read;
  PointsPly result;
  for (const PlyElement& element : header.elements) {
    if (&element != vertex) {
      values.skip_rows(element);
      continue;
    }
    input.make_room_in(read, vertex->count, "the points");
    for (std::uint64_t row = 0; row < vertex->count; ++row) {
      std::array<double, 6> numbers{};
      values.read_row(*vertex, columns.slots,
                      [&](std::size_t slot, double value) { numbers[slot] = value; });
      const glm::dvec3 position(numbers[0], numbers[1], numbers[2]);
      const glm::vec3 color(numbers[3], numbers[4], numbers[5]);
      if (std::isfinite(position.x + position.y + position.z + color.x + color.y + color.z))
        read.push_back({position, color});
      else
        ++result.skipped;
    }
    break;
  }
  const double full = full_channel(read, columns.are_floats);
  input.make_room_in(result.points, read.size(), "the points");
  for (const RawPoint& point : read) {
    glm::u8vec3 color(128);
    for (int c = 0; c < 3 && columns.has_colors; ++c) {
      const double channel = columns.are_harmonics ? channel_of_harmonic(point.color[c])
                                                   : double(point.color[c]) / full;
      color[c] = glm::u8(std::lround(255 * std::clamp(channel, 0.0, 1.0)));
    }
    result.points.push_back({point.position, color});
  }
  return result;
}

}  // namespace tureen
