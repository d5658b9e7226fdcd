#include <algorithm>

#include "formats/glb/glb_arrays.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "formats/tureen_glb/tureen_glb_layout.hpp"
#include "formats/tureen_glb/tureen_glb_splats.hpp"
#include "scene/edit/splat_edits.hpp"
#include "scene/edit/splat_limit.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

namespace splat_layout = glb_layout;

JsonView primitive_of(const GlbArrays& arrays, const JsonView& node) {
  return arrays.root()["meshes"].at(GlbArrays::index(node["mesh"]))["primitives"].at(0);
}

/// TUREEN_splats of a primitive.
JsonView ours_of(const JsonView& primitive) {
  return primitive["extensions"][splat_layout::splatting_extension]["extensions"]
                  [splat_layout::splats_extension];
}

/// Where a layer's splats are.
struct SplatLayout {
  JsonView ours;       // TUREEN_splats
  SplatKernel kernel;  // without splats
  std::uint64_t splats = 0;
  std::vector<GlbArrays::Location> columns = {};       // of the kernel
  std::vector<GlbArrays::Location> coefficients = {};  // one array each
};

/// The kernel that `ours` names.
SplatKernel kernel_without_splats(const JsonView& ours) {
  std::vector<const char*> names;
  for (const StoredKernel& each : stored_kernels) names.push_back(each.name);
  return stored_kernels[ours["kernel"].one_of(names)].kernel;
}

template <class Value>
constexpr GlbArrays::Format format_of = sizeof(Value) == sizeof(glm::quat) ? glb_formats::vec4_float
                                        : sizeof(Value) == sizeof(glm::vec3)
                                            ? glb_formats::vec3_float
                                            : glb_formats::scalar_float;

/// Locates every array before any is read: a false count fails before the memory is taken.
SplatLayout splat_layout_of(const GlbArrays& arrays, const JsonView& node,
                            const JsonView& splat_count, int max_degree) {
  const std::uint64_t splats = splat_count.natural(GlbArrays::max_count);
  if (splats == 0) {
    const JsonView ours = node["extensions"][tureen_extension]["splats"];
    return {.ours = ours, .kernel = kernel_without_splats(ours)};
  }
  const JsonView primitive = primitive_of(arrays, node), attributes = primitive["attributes"];
  const JsonView ours = ours_of(primitive);
  SplatLayout layout{.ours = ours, .kernel = kernel_without_splats(ours), .splats = splats};
  for_each_possible_column(layout.kernel, [&]<class Values>(const Column<Values>& column) {
    const std::string key = column_key(column);
    const JsonView& holder = is_attribute(column) ? attributes : ours;
    const bool exists = column.role != ColumnRole::label || holder.find(key.c_str());
    layout.columns.push_back(arrays.location(holder, key.c_str(),
                                             exists ? column.per_splat * splats : 0,
                                             format_of<typename Values::value_type>));
  });
  const int degree = std::min(int(ours["degree"].natural(harmonics::max_degree)), max_degree);
  for (int l = 0; l <= degree; ++l)
    for (int order = 0; order < 2 * l + 1; ++order)
      layout.coefficients.push_back(arrays.location(
          attributes, harmonics_attribute(l, order).c_str(), splats, glb_formats::vec3_float));
  return layout;
}

SplatKernel read_kernel(GlbArrays& arrays, const SplatLayout& layout) {
  SplatKernel kernel = layout.kernel;
  auto location = layout.columns.begin();
  if (layout.splats > 0)
    for_each_possible_column(kernel, [&]<class Values>(const Column<Values>& column) {
      const std::string key = column_key(column);
      column.values = arrays.read_at<typename Values::value_type>(
          *location++, key.substr(key.find(':') + 1).c_str());
    });
  const auto read = [&](const char* name, float& value) {
    value = layout.ours[name].number_float();
  };
  std::visit([&](auto& each) { for_each_constant(each, read); }, kernel);
  return kernel;
}

/// The coefficients of the `kept` splats with a nonzero entry in `keeps`.
std::vector<glm::vec3> read_coefficients(GlbArrays& arrays, const SplatLayout& layout,
                                         std::span<const std::uint8_t> keeps, std::size_t kept) {
  const std::size_t stride = layout.coefficients.size();
  arrays.take_memory(kept * stride, sizeof(glm::vec3), "harmonics");
  std::vector<glm::vec3> result(kept * stride);
  for (std::size_t k = 0; k < stride; ++k) {
    PassingMemory passing(arrays.budget());
    const auto plane = arrays.read_at<glm::vec3>(layout.coefficients[k], "harmonics");
    std::size_t at = k;
    for (std::size_t i = 0; i < plane.size(); ++i)
      if (keeps[i]) {
        result[at] = plane[i];
        at += stride;
      }
  }
  return result;
}

}  // namespace

SplatProfile read_splat_profile(const JsonView& view) {
  SplatProfile profile;
  profile.projection =
      SplatProfile::Projection(view["projection"].one_of(splat_layout::splat_projections));
  profile.low_pass = SplatProfile::LowPass(view["low_pass"].one_of(splat_layout::splat_low_passes));
  profile.max_alpha = view["max_alpha"].number_float();
  profile.min_alpha = view["min_alpha"].number_float();
  profile.stop_transmittance = view["stop_transmittance"].number_float();
  if (const auto depth = view.find("min_center_depth"))
    profile.min_center_depth = depth->number_float();
  return profile;
}

Splats read_splats(GlbArrays& arrays, const JsonView& node, const JsonView& splat_count,
                   const SplatPart& part) {
  const SplatLayout layout = splat_layout_of(arrays, node, splat_count, part.max_degree);
  Splats splats;
  splats.profile = read_splat_profile(layout.ours["profile"]);
  splats.kernel = read_kernel(arrays, layout);
  splats.color.degree =
      std::min(int(layout.ours["degree"].natural(harmonics::max_degree)), part.max_degree);
  const auto all = static_cast<std::size_t>(layout.splats);
  const std::size_t kept = std::min<std::uint64_t>(all, part.max_splats.value_or(all));
  std::vector<std::uint8_t> keeps(all, 1);
  if (kept < all) {
    PassingMemory passing(arrays.budget());
    arrays.take_memory(all, limit_bytes_per_splat, "the order of the splats");
    keeps = largest_splats(splats.kernel, kept);
    keep_splats(splats.kernel, keeps);
  }
  if (all > 0) splats.color.coefficients = read_coefficients(arrays, layout, keeps, kept);
  if (const auto reason = defect(splats)) layout.ours.fail(*reason);
  return splats;
}

std::uint64_t splat_bytes(const GlbArrays& arrays, const JsonView& node,
                          const JsonView& splat_count) {
  const std::uint64_t splats = splat_count.natural(GlbArrays::max_count);
  if (splats == 0) return 0;
  const JsonView ours = ours_of(primitive_of(arrays, node));
  return splats * bytes_per_splat(kernel_without_splats(ours),
                                  int(ours["degree"].natural(harmonics::max_degree)));
}

std::uint64_t splats_end(const GlbArrays& arrays, const JsonView& node, const JsonView& splat_count,
                         int max_degree) {
  const SplatLayout layout = splat_layout_of(arrays, node, splat_count, max_degree);
  std::uint64_t end = 0;
  for (const auto* locations : {&layout.columns, &layout.coefficients})
    for (const GlbArrays::Location& each : *locations) end = std::max(end, each.end());
  return end;
}

}  // namespace tureen
