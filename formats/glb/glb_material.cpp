#include "formats/glb/glb_material.hpp"

#include <optional>

#include "base/json/json_vector.hpp"
#include "image/srgb.hpp"

namespace tureen {

namespace {

/// The number in extensions[extension][key], if both exist.
float extension_number(const JsonView& material, const char* extension, const char* key,
                       float otherwise) {
  const auto extensions = material.find("extensions");
  const auto found = extensions ? extensions->find(extension) : std::nullopt;
  const auto number = found ? found->find(key) : std::nullopt;
  return number ? number->number_float() : otherwise;
}

}  // namespace

Material read_glb_material(const JsonView& material) {
  Material result{.metallic = 1.0f};  // glTF's default
  if (const auto pbr = material.find("pbrMetallicRoughness")) {
    if (const auto color = pbr->find("baseColorFactor"))
      result.base_color = glm::vec3(srgb_from_linear(glm::dvec3(json_vector<4, double>(*color))));
    if (const auto metallic = pbr->find("metallicFactor"))
      result.metallic = metallic->number_float();
    if (const auto roughness = pbr->find("roughnessFactor"))
      result.roughness = roughness->number_float();
  }
  result.transmission =
      extension_number(material, transmission_extension, "transmissionFactor", 0.0f);
  result.ior = extension_number(material, ior_extension, "ior", default_ior);
  return result;
}

nlohmann::json glb_material_json(const Material& material) {
  const glm::dvec3 linear = linear_from_srgb(glm::dvec3(material.base_color));
  nlohmann::json json = {{"doubleSided", true},
                         {"alphaMode", "OPAQUE"},
                         {"pbrMetallicRoughness",
                          {{"baseColorFactor", {linear.x, linear.y, linear.z, 1.0}},
                           {"metallicFactor", material.metallic},
                           {"roughnessFactor", material.roughness}}}};
  if (material.transmission != 0.0f)
    json["extensions"][transmission_extension] = {{"transmissionFactor", material.transmission}};
  if (material.ior != default_ior) json["extensions"][ior_extension] = {{"ior", material.ior}};
  return json;
}

}  // namespace tureen
