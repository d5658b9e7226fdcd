// Material as glTF's JSON has it: pbrMetallicRoughness, KHR_materials_transmission and
// KHR_materials_ior. Our own files and foreign ones share it. Include it only in sources.
#pragma once

#include <nlohmann/json.hpp>

#include "base/json/json_view.hpp"
#include "scene/material.hpp"

namespace tureen {

inline constexpr char transmission_extension[] = "KHR_materials_transmission";
inline constexpr char ior_extension[] = "KHR_materials_ior";

/// The factors of an element of glTF's `materials`, with glTF's defaults; textures are not read.
/// Ranges are not checked (defect()). Throws InputError for a value of the wrong type.
Material read_glb_material(const JsonView& material);

/// The element of `materials`: reads back as the same numbers.
nlohmann::json glb_material_json(const Material& material);

}  // namespace tureen
