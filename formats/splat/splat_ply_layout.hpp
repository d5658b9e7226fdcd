// The properties of a splat PLY, found by their names.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/ply/ply_header.hpp"
#include "formats/splat/splat_builder.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

/// The slot of each property that an element must have.
using PlySlots = std::map<std::string, int, std::less<>>;

/// Adds "prefix0", "prefix1", .. with the slots first, first + 1, ..
void add_slots(PlySlots& slots, const char* prefix, int first, int count);

/// The slot of each property of the element, or -1 for other properties. Throws InputError with the
/// element's line if one of `required` is missing, occurs twice or is a list.
std::vector<int> find_slots(const Input& input, const PlyElement& element, PlySlots required);

/// The degree of harmonics with `properties` values beyond degree 0. Throws InputError with the
/// element's line if there is none.
int degree_of_rest(const Input& input, const PlyElement& element, std::size_t properties);

/// The number of properties 'f_rest_..'.
std::size_t count_rest(const PlyElement& element);

/// The place of f_rest_k in [coefficient][rgb], from f_rest's first coefficient on.
int place_of_rest(int k, int degree);

/// Slots of the values of one splat, in the order of the model: harmonics as [coefficient][rgb],
/// networks as in NeuralDensities.
namespace splat_slot {
inline constexpr int center = 0, opacity = 3, scale = 4, rotation = 7, color = 11,
                     network = color + 3 * harmonics::count(harmonics::max_degree),
                     filter = network + int(NeuralDensities::parameters),  // of Mip-Splatting
    count = filter + 1, none = -1;
}  // namespace splat_slot

struct SplatPlyProperty {
  std::string name;
  int slot;  // or none, if readers need no such property and we write 0
};
/// The properties of the vertices, in the order of the authors' programs.
std::vector<SplatPlyProperty> splat_ply_properties(const SplatKernel& kernel, int scales,
                                                   int degree);

struct SplatPlyLayout {
  SplatKernel kernel = Gaussians{};  // without splats
  int degree = 0;
  /// One a property of the vertices: its slot, or none.
  std::vector<int> slots;
  /// Number of scales in the file: 2 or 3.
  int scales = 3;
  /// Colours are red, green and blue with this value of a full channel; 0: harmonics.
  double full_channel = 0;
  bool has_filter = false;
};

/// Throws InputError with the element's line: a property is missing, occurs twice or is a list, or
/// the number of f_rest fits no degree.
SplatPlyLayout splat_ply_layout(const Input& input, const PlyElement& vertex);

struct SplatPlyProfile {
  SplatProfile profile = {};
  bool is_flat = false;       // by the profile, also with three scales
  bool normal_first = false;  // the discs span the local y and z axes (GaMeS)
  std::string assumed = {};   // name of a profile that no comment selects, or empty
  /// The SplatRenderMode of the last comment that names no known one, or empty.
  std::string unknown_mode = {};
  /// Of Nerfstudio's comment "Vertical Axis: z".
  std::optional<glm::vec3> up = {};
};

/// The profile that the header's comments select; `kernel` is that of the properties.
SplatPlyProfile splat_ply_profile(const PlyHeader& header, const SplatKernel& kernel);

/// Adds the remarks about `assumed` and `unknown_mode` to a scene of one layer of splats.
void add_profile_remarks(const SplatPlyProfile& profile, Scene& scene);

}  // namespace tureen
