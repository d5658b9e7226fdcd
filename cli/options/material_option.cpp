#include "cli/options/material_option.hpp"

#include "base/error.hpp"

namespace tureen::cli {

MaterialChoice parse_material_choice(const std::string& text) {
  const auto fail = [&](const std::string& reason) {
    throw UsageError("--material " + text + ": " + reason,
                     "LAYER=mirror, LAYER=glass, LAYER=glass:1.33 or LAYER=stored");
  };
  const std::size_t equals = text.rfind('=');  // a name may contain one
  if (equals == text.npos || equals == 0) fail("no layer and material");
  MaterialChoice choice{.layer = text.substr(0, equals)};
  const std::string word = text.substr(equals + 1);
  if (word == "stored") return choice;
  choice.material = glass_material(default_ior);
  if (word == "mirror") {
    choice.material = mirror_material();
  } else if (word.starts_with("glass:")) {
    const std::optional<double> ior = number_from(word.substr(6));
    if (!ior) fail("'" + word.substr(6) + "' is not a number");
    choice.material->ior = float(*ior);
    if (const auto reason = defect(*choice.material)) fail(*reason);
  } else if (word != "glass") {
    fail("'" + word + "' is not a material; there are mirror, glass and stored");
  }
  return choice;
}

void add_material_option(Command& command, MaterialChoices& choices) {
  command
      .add_option(
          "--material LAYER=NAME",
          [&choices](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) choices.push_back(parse_material_choice(text));
          },
          "surface of a mesh layer for rays: mirror, glass (index of refraction 1.5), glass:IOR, "
          "or stored (default); may be repeated")
      .repeatable();
}

void apply_materials(const MaterialChoices& choices, Scene& scene) {
  std::vector<std::optional<Material>> stored;
  for (const Layer& layer : scene.layers) stored.push_back(layer.material);
  for (const MaterialChoice& choice : choices) {
    Layer& layer = layer_named(scene, choice.layer);
    if (!std::holds_alternative<TriangleSoup>(layer.primitives))
      throw UsageError("--material: the layer " + choice.layer +
                       " has splats; only meshes have a surface");
    const auto index = std::size_t(&layer - scene.layers.data());
    layer.material = choice.material ? choice.material : stored[index];
  }
}

}  // namespace tureen::cli
