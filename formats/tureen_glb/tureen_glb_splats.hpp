// Layers of splats around centres in our GLB files, version 5 (docs/format.md): points with
// KHR_gaussian_splatting. Other viewers draw the Gaussians, or else points. TUREEN_splats, an
// extension of the same object, holds what KHR_gaussian_splatting does not: other kernels, degree 4
// and the profile. Include it only in sources.
//
// Not here: triangle windows, whose files have a mesh of triangles (AddAppearance and its
// neighbours in tureen_glb_write.cpp).
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>

#include "scene/spherical_harmonics.hpp"
#include "scene/splats.hpp"

namespace tureen {

class GlbArrays;
class JsonView;

namespace glb_writing {

class BinaryPlan;

/// Whether version 4 cannot store the splats: not triangle windows, colours of corners, or a
/// profile that differs from Triangle Splatting's.
bool needs_splat_version(const Splats& splats);

nlohmann::json profile_json(const SplatProfile& profile);

/// Adds the arrays of splats that are no triangle windows to the plan, and the keys of the layer to
/// `extension`. Returns the primitive; null without splats. The splats must outlive the plan.
/// Throws UsageError for a defect().
nlohmann::json add_splats(BinaryPlan& plan, nlohmann::json& extension, const Splats& splats);

}  // namespace glb_writing

/// The attribute of harmonics coefficient `order` of `degree`, from 0:
/// "KHR_gaussian_splatting:SH_DEGREE_1_COEF_2". Degree 4 has the prefix of TUREEN_splats.
std::string harmonics_attribute(int degree, int order);

/// Kernels without splats, by their names in TUREEN_splats.
struct StoredKernel {
  const char* name;
  SplatKernel kernel;
};
inline const StoredKernel stored_kernels[] = {
    {"gaussian", Gaussians{}},
    {"flat_gaussian", Gaussians{.flat = true}},
    {"neural_density", NeuralDensities{}},
};

/// The attribute of a column with this role.
std::string attribute_key(ColumnRole role);
/// Whether KHR_gaussian_splatting has an attribute for the column. TUREEN_splats has the others.
template <class Values>
constexpr bool is_attribute(const Column<Values>& column) {
  if (column.role == ColumnRole::scale)
    return std::is_same_v<typename Values::value_type, glm::vec3>;
  return column.role != ColumnRole::value && column.role != ColumnRole::label;
}
template <class Values>
std::string column_key(const Column<Values>& column) {
  return is_attribute(column) ? attribute_key(column.role) : plural(column.name);
}

SplatProfile read_splat_profile(const JsonView& view);

/// The part of a layer's splats that is read.
struct SplatPart {
  int max_degree = harmonics::max_degree;        // harmonics above it are not read
  std::optional<std::uint64_t> max_splats = {};  // as largest_splats() keeps them
};

/// The splats of a layer, `node`, with `splat_count` from the layer's extension. They have no
/// defect(). Throws InputError.
Splats read_splats(GlbArrays& arrays, const JsonView& node, const JsonView& splat_count,
                   const SplatPart& part = {});

/// Bytes of the splats in memory; no array is read.
std::uint64_t splat_bytes(const GlbArrays& arrays, const JsonView& node,
                          const JsonView& splat_count);

/// The number of leading bytes of the file that read_splats() needs.
std::uint64_t splats_end(const GlbArrays& arrays, const JsonView& node, const JsonView& splat_count,
                         int max_degree);

}  // namespace tureen
