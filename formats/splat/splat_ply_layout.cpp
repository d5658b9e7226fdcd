#include "formats/splat/splat_ply_layout.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "formats/splat/splat_remarks.hpp"

namespace tureen {

std::vector<SplatPlyProperty> splat_ply_properties(const SplatKernel& kernel, int scales,
                                                   int degree) {
  namespace slot = splat_slot;
  std::vector<SplatPlyProperty> properties;
  const auto add = [&](const char* prefix, int first, int count) {
    for (int i = 0; i < count; ++i) properties.push_back({prefix + std::to_string(i), first + i});
  };
  for (const int axis : {0, 1, 2})
    properties.push_back({std::string(1, "xyz"[axis]), slot::center + axis});
  for (const char* normal : {"nx", "ny", "nz"}) properties.push_back({normal, slot::none});
  add("f_dc_", slot::color, 3);
  for (int k = 0; k < 3 * (harmonics::count(degree) - 1); ++k)
    properties.push_back(
        {"f_rest_" + std::to_string(k), slot::color + 3 + place_of_rest(k, degree)});
  const bool has_opacity = opacity_of(kernel);
  properties.push_back({"opacity", has_opacity ? slot::opacity : slot::none});
  if (!has_opacity) properties.push_back({"opacity_volr", slot::none});
  add("scale_", slot::scale, scales);
  add("rot_", slot::rotation, 4);
  if (has_opacity) return properties;
  constexpr int width = NeuralDensities::width;
  for (int k = 0; k < 3 * width; ++k)
    properties.push_back(
        {"frequencies_" + std::to_string(k), slot::network + 3 * (k % width) + k / width});
  add("phases_", slot::network + 3 * width, width);
  add("amplitudes_", slot::network + 4 * width, width);
  properties.push_back({"offsets", slot::network + 5 * width});
  return properties;
}

void add_slots(PlySlots& slots, const char* prefix, int first, int count) {
  for (int i = 0; i < count; ++i) slots[prefix + std::to_string(i)] = first + i;
}

std::vector<int> find_slots(const Input& input, const PlyElement& element, PlySlots required) {
  constexpr int found = splat_slot::none;
  std::vector<int> slots(element.properties.size(), splat_slot::none);
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    const auto known = required.find(property.name);
    if (known == required.end()) continue;
    if (property.count_type) fail_element(input, element, "has a list '" + property.name + "'");
    if (known->second == found)
      fail_element(input, element, "has a second property '" + property.name + "'");
    slots[i] = known->second;
    known->second = found;
  }
  for (const auto& [name, slot] : required)
    if (slot != found) fail_element(input, element, "lacks '" + name + "'");
  return slots;
}

int degree_of_rest(const Input& input, const PlyElement& element, std::size_t properties) {
  for (int degree = 0; degree <= harmonics::max_degree; ++degree)
    if (properties == std::size_t(3 * (harmonics::count(degree) - 1))) return degree;
  fail_element(input, element,
               "has " + std::to_string(properties) +
                   " properties 'f_rest_..', which fit no degree of harmonics; supported: 0, 9, "
                   "24, 45 and 72");
}

std::size_t count_rest(const PlyElement& element) {
  const auto is_rest = [](const PlyProperty& p) {
    return std::string_view(p.name).substr(0, 7) == "f_rest_";
  };
  return std::size_t(std::count_if(element.properties.begin(), element.properties.end(), is_rest));
}

int place_of_rest(int k, int degree) {
  const int per_channel = harmonics::count(degree) - 1;
  return 3 * (k % per_channel) + k / per_channel;
}

namespace {

/// Files with plain colours, such as Nerfstudio's with --ply-color-mode rgb, have no harmonics.
void take_colors(const PlyElement& vertex, SplatPlyLayout& layout, PlySlots& required) {
  constexpr const char* channels[] = {"red", "green", "blue"};
  if (vertex.find("f_dc_0") || layout.degree > 0) return;
  const std::optional<std::size_t> red = vertex.find("red");
  if (!red || !vertex.find("green") || !vertex.find("blue")) return;
  for (int c = 0; c < 3; ++c) {
    required.erase("f_dc_" + std::to_string(c));
    required[channels[c]] = splat_slot::color + c;
  }
  const PlyType type = vertex.properties[*red].type;
  layout.full_channel = !is_integer(type) ? 1 : type == PlyType::uint16 ? 65535 : 255;
}

/// The axis that "x", "-x", "y" and so on name.
std::optional<glm::vec3> axis_of(std::string_view name) {
  const float sign = name.starts_with('-') ? -1.0f : 1.0f;
  if (name.starts_with('-') || name.starts_with('+')) name.remove_prefix(1);
  if (name.size() != 1 || name[0] < 'x' || name[0] > 'z') return std::nullopt;
  glm::vec3 axis(0.0f);
  axis[name[0] - 'x'] = sign;
  return axis;
}

}  // namespace

SplatPlyLayout splat_ply_layout(const Input& input, const PlyElement& vertex) {
  SplatPlyLayout layout;
  if (vertex.find("frequencies_0")) {
    layout.kernel = NeuralDensities{};
  } else if (!vertex.find("scale_2")) {
    layout.kernel = Gaussians{.flat = true};
    layout.scales = 2;
  }
  layout.degree = degree_of_rest(input, vertex, count_rest(vertex));
  PlySlots required;
  for (const auto& [name, slot] : splat_ply_properties(layout.kernel, layout.scales, layout.degree))
    if (slot != splat_slot::none) required[name] = slot;
  take_colors(vertex, layout, required);
  layout.has_filter = layout.scales == 3 && vertex.find("filter_3D") &&
                      std::holds_alternative<Gaussians>(layout.kernel);
  if (layout.has_filter) required["filter_3D"] = splat_slot::filter;
  layout.slots = find_slots(input, vertex, std::move(required));
  return layout;
}

SplatPlyProfile splat_ply_profile(const PlyHeader& header, const SplatKernel& kernel) {
  const auto* gaussians = std::get_if<Gaussians>(&kernel);
  if (!gaussians) return {.profile = *profile_named("splatnet")};
  constexpr std::string_view render_mode = "SplatRenderMode: ", vertical = "Vertical Axis: ";
  std::string_view mode, unknown;
  std::optional<glm::vec3> up;
  for (std::string_view rest = header.comments; !rest.empty();) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    if (line.substr(0, render_mode.size()) == render_mode) {
      const std::string_view value = line.substr(render_mode.size());
      const bool is_known = value == "default" || value == "mip" || value == "2dgs";
      (is_known ? mode : unknown) = value;
    }
    if (line.starts_with(vertical)) up = axis_of(line.substr(vertical.size()));
    if (line == "antialiased 0") mode = "default";
    if (line == "antialiased 1") mode = "mip";
    if (line == "TureenSplatProfile: redisplats") mode = "redisplats";
  }
  const bool is_flat = gaussians->flat;
  SplatPlyProfile result{.is_flat = is_flat, .unknown_mode = std::string(unknown), .up = up};
  if (mode == "2dgs" || (is_flat && mode.empty())) {
    result.is_flat = true;
    if (mode.empty() && unknown.empty()) result.assumed = "2dgs";
    result.profile = *profile_named("2dgs");
    return result;
  }
  result.normal_first = is_flat;
  result.profile = *profile_named(mode == "redisplats" && is_flat ? "redisplats"
                                  : mode == "mip"                 ? "mip"
                                  : is_flat                       ? "games"
                                                                  : "3dgs");
  return result;
}

void add_profile_remarks(const SplatPlyProfile& profile, Scene& scene) {
  if (profile.up) choose_up(scene.info, *profile.up);
  std::vector<Remark>& remarks = scene.info.remarks;
  if (!profile.assumed.empty())
    remarks.push_back({&remarks::profile_assumed, {{"profile", profile.assumed}}});
  if (profile.unknown_mode.empty()) return;
  const auto& splats = std::get<Splats>(only_layer(scene).primitives);
  remarks.push_back(
      {&remarks::render_mode_unknown,
       {{"mode", profile.unknown_mode}, {"profile", std::string(profile_name(splats))}}});
}

}  // namespace tureen
