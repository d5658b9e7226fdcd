#include "formats/dataset/points_ply.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "formats/ply/ply_header.hpp"
#include "formats/ply/ply_values.hpp"
#include "formats/read_options.hpp"

namespace tureen {

namespace {

constexpr std::array<const char*, 6> point_properties{"x", "y", "z", "red", "green", "blue"};
constexpr std::size_t first_point_color = 3;
constexpr int skipped_property = -1;

/// The slot of each property, `skipped_property` for a skipped one.
std::vector<int> point_slots(const PlyElement& vertex, const std::string& file) {
  const auto fail = [&](const std::string& reason) {
    throw InputError({file, {}, vertex.line}, reason);
  };
  std::vector<int> slots(vertex.properties.size(), skipped_property);
  for (std::size_t slot = 0; slot < point_properties.size(); ++slot) {
    const std::string name = point_properties[slot];
    const std::optional<std::size_t> found = vertex.find(name);
    if (!found) {
      if (slot < first_point_color) fail("the element 'vertex' has no property '" + name + "'");
      continue;
    }
    const PlyProperty& property = vertex.properties[*found];
    if (property.count_type) fail("the property '" + name + "' is a list");
    if (slot >= first_point_color && property.type != PlyType::uint8)
      fail("the property '" + name + "' is not of type uchar");
    slots[*found] = int(slot);
  }
  return slots;
}

}  // namespace

std::vector<DatasetPoint> read_points_ply(Input& input) {
  const PlyHeader header = read_ply_header(input);
  const PlyElement* vertex = header.find("vertex");
  if (!vertex)
    throw InputError({input.name(), {}, header.body_line - 1}, "has no element 'vertex'");
  const std::vector<int> slots = point_slots(*vertex, input.name());
  const ReadOptions options;
  PlyValues values(input, header, options);
  std::vector<DatasetPoint> points;
  for (const PlyElement& element : header.elements) {
    if (&element != vertex) {
      values.skip_rows(element);
      continue;
    }
    input.make_room_in(points, vertex->count, "the points");
    for (std::uint64_t row = 0; row < vertex->count; ++row) {
      std::array<double, point_properties.size()> numbers{0, 0, 0, 128, 128, 128};
      values.read_row(*vertex, slots,
                      [&](std::size_t slot, double value) { numbers[slot] = value; });
      const auto& [x, y, z, red, green, blue] = numbers;
      if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z))
        values.fail("a point's position is not finite");
      points.push_back({{x, y, z}, {glm::u8(red), glm::u8(green), glm::u8(blue)}});
    }
    break;
  }
  return points;
}

}  // namespace tureen
