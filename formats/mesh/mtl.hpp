// Material libraries of OBJ (MTL): the diffuse colour, its texture and the opacity.
//
// Supported: newmtl, Kd r g b, d, Tr, map_Kd and map_d with PNG, JPEG or WebP files, and the option
// -clamp. Other lines, such as specular colours and bump maps, are skipped: soups are drawn unlit.
#pragma once

#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>

#include "base/input.hpp"

namespace tureen {

struct MtlMaterial {
  std::optional<glm::vec3> color;  // Kd, display-referred
  float opacity = 1;               // d, or 1 - Tr
  std::string image;               // of map_Kd, a path relative to the library; empty: none
  std::string mask;                // of map_d
  bool clamps = false;
  bool is_placed = false;  // has an offset, scale or turbulence (-o, -s, -t), which is skipped
};

/// The materials by name; the last one of a name counts. Throws InputError with the line for an
/// invalid number.
std::map<std::string, MtlMaterial> read_mtl(Input& input);

}  // namespace tureen
