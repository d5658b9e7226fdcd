// --material LAYER=mirror|glass[:IOR]|stored: the surfaces of mesh layers, by the user's choice.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/options/arguments.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

struct MaterialChoice {
  std::string layer;                      // a label()
  std::optional<Material> material = {};  // nullopt: as stored
};
using MaterialChoices = std::vector<MaterialChoice>;

/// Throws UsageError with the expected form for any other text.
MaterialChoice parse_material_choice(const std::string& text);

/// Adds --material, which may be repeated. `choices` must live until the arguments are parsed.
void add_material_option(Command& command, MaterialChoices& choices);

/// Sets the materials; of several choices for a layer, the last one counts. Throws UsageError,
/// which lists the layers, for one that the scene lacks, and for a layer of splats.
void apply_materials(const MaterialChoices& choices, Scene& scene);

}  // namespace tureen::cli
