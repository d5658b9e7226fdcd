#include "formats/gltf/gltf_surface.hpp"

#include "formats/glb/glb_material.hpp"
#include "formats/gltf/gltf_remarks.hpp"

namespace tureen {

namespace {

/// Whether material[part][key] exists, for a part of the JSON that may be missing.
bool has(const std::optional<JsonView>& part, const char* key) {
  return part && part->find(key).has_value();
}

}  // namespace

std::optional<Material> read_gltf_surface(const GltfDocument& document, int index,
                                          std::vector<Remark>& remarks) {
  if (index < 0) return std::nullopt;
  const JsonView json = document.root()["materials"].at(std::size_t(index));
  const auto extensions = json.find("extensions");
  if (has(extensions, "KHR_materials_unlit")) return std::nullopt;
  const Material material = read_glb_material(json);
  if (!is_mirror(material) && !is_glass(material)) return std::nullopt;

  const auto drop = [&](const std::string& reason) {
    remarks.push_back({&remarks::surface_dropped, {{"material", json.path()}, {"reason", reason}}});
    return std::nullopt;
  };
  if (const auto reason = defect(material)) return drop(*reason);
  const auto pbr = json.find("pbrMetallicRoughness");
  const auto transmission = extensions ? extensions->find(transmission_extension) : std::nullopt;
  if (has(pbr, "metallicRoughnessTexture") || has(transmission, "transmissionTexture"))
    return drop("a texture varies its metallic, roughness or transmission factor");
  if (has(pbr, "baseColorTexture"))
    remarks.push_back({&remarks::surface_texture_dropped, {{"material", json.path()}}});
  return material;
}

}  // namespace tureen
