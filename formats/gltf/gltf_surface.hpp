// Mirrors and glass of a foreign glTF file: materials by which rays see more than a colour.
#pragma once

#include <optional>
#include <vector>

#include "formats/gltf/gltf_document.hpp"
#include "scene/material.hpp"
#include "scene/remark.hpp"

namespace tureen {

/// materials[index] if it is a mirror or glass (scene/material.hpp), nullopt for all others and for
/// -1. The index must exist. Appends a remark if the material would be one, but has a value outside
/// its range or varies by a texture. Throws InputError for a value of the wrong type.
std::optional<Material> read_gltf_surface(const GltfDocument& document, int index,
                                          std::vector<Remark>& remarks);

}  // namespace tureen
