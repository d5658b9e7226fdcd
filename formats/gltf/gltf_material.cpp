#include "formats/gltf/gltf_material.hpp"

#include <algorithm>
#include <cmath>

#include "formats/gltf/gltf_remarks.hpp"

namespace tureen {

namespace {

UvMaterial::Wrap wrap_of(const GltfDocument& document, int mode, const std::string& where) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return UvMaterial::Wrap::repeat;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return UvMaterial::Wrap::mirror;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return UvMaterial::Wrap::clamp;
    default:
      document.fail(where, "wrap mode " + std::to_string(mode) + " is unknown");
  }
}

/// Without mip levels the magnification filter applies. If it is missing, the first half of the
/// minification filter's name applies.
UvMaterial::Filter filter_of(const tinygltf::Sampler& sampler) {
  const bool nearest_min = sampler.minFilter == TINYGLTF_TEXTURE_FILTER_NEAREST ||
                           sampler.minFilter == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST ||
                           sampler.minFilter == TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR;
  const bool nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST ||
                       (sampler.magFilter < 0 && nearest_min);
  return nearest ? UvMaterial::Filter::nearest : UvMaterial::Filter::linear;
}

glm::dvec2 pair_of(const GltfDocument& document, const tinygltf::Value& value, const char* key,
                   glm::dvec2 otherwise, const std::string& where) {
  if (!value.Has(key)) return otherwise;
  const tinygltf::Value& pair = value.Get(key);
  if (!pair.IsArray() || pair.ArrayLen() != 2 || !pair.Get(0).IsNumber() || !pair.Get(1).IsNumber())
    document.fail(where, std::string("its ") + key + " is not two numbers");
  return {pair.Get(0).GetNumberAsDouble(), pair.Get(1).GetNumberAsDouble()};
}

/// KHR_texture_transform: scale, rotate counter-clockwise (v points down), translate.
void read_transform(const GltfDocument& document, const tinygltf::Value& value,
                    const std::string& where, GltfMaterial& material) {
  const glm::dvec2 offset = pair_of(document, value, "offset", {0, 0}, where);
  const glm::dvec2 scale = pair_of(document, value, "scale", {1, 1}, where);
  double angle = 0.0;
  if (value.Has("rotation")) {
    if (!value.Get("rotation").IsNumber()) document.fail(where, "its rotation is not a number");
    angle = value.Get("rotation").GetNumberAsDouble();
  }
  if (value.Has("texCoord")) {
    if (!value.Get("texCoord").IsInt()) document.fail(where, "its texCoord is not a number");
    material.texture_coordinate = value.Get("texCoord").GetNumberAsInt();
  }
  const double c = std::cos(angle), s = std::sin(angle);
  material.uv_transform =
      glm::dmat3x2(c * scale.x, -s * scale.x, s * scale.y, c * scale.y, offset.x, offset.y);
}

void read_texture(const GltfDocument& document, const tinygltf::TextureInfo& info,
                  const std::string& where, GltfMaterial& material) {
  const tinygltf::Model& model = document.model();
  if (info.index < 0 || std::size_t(info.index) >= model.textures.size())
    document.fail(where, "names texture " + std::to_string(info.index) + " of " +
                             std::to_string(model.textures.size()));
  const std::string texture_name = "textures[" + std::to_string(info.index) + "]";
  const tinygltf::Texture& texture = model.textures[std::size_t(info.index)];
  if (texture.source < 0) {
    std::string extensions;
    for (const auto& [name, ignored] : texture.extensions) extensions += " " + name;
    document.fail(texture_name, extensions.empty()
                                    ? "has no image"
                                    : "has no PNG or JPEG image beside" + extensions);
  }
  material.image = texture.source;
  material.texture_coordinate = info.texCoord;
  if (texture.sampler >= 0) {
    if (std::size_t(texture.sampler) >= model.samplers.size())
      document.fail(texture_name, "names sampler " + std::to_string(texture.sampler) + " of " +
                                      std::to_string(model.samplers.size()));
    const std::string sampler_name = "samplers[" + std::to_string(texture.sampler) + "]";
    const tinygltf::Sampler& sampler = model.samplers[std::size_t(texture.sampler)];
    material.wrap_u = wrap_of(document, sampler.wrapS, sampler_name);
    material.wrap_v = wrap_of(document, sampler.wrapT, sampler_name);
    material.filter = filter_of(sampler);
  }
  const auto transform = info.extensions.find("KHR_texture_transform");
  if (transform != info.extensions.end())
    read_transform(document, transform->second, where + ".extensions.KHR_texture_transform",
                   material);
  if (material.texture_coordinate < 0)
    document.fail(where, "names TEXCOORD_" + std::to_string(material.texture_coordinate));
}

}  // namespace

GltfMaterial read_gltf_material(const GltfDocument& document, int index,
                                std::vector<Remark>& remarks) {
  GltfMaterial result;
  if (index < 0) return result;
  const auto& materials = document.model().materials;
  if (std::size_t(index) >= materials.size())
    document.fail("materials", "there is no material " + std::to_string(index) + " of " +
                                   std::to_string(materials.size()));
  const std::string where = "materials[" + std::to_string(index) + "]";
  const tinygltf::Material& material = materials[std::size_t(index)];

  const std::vector<double>& factor = material.pbrMetallicRoughness.baseColorFactor;
  if (factor.size() != 4)
    document.fail(where + ".pbrMetallicRoughness.baseColorFactor", "expected four numbers");
  for (int k = 0; k < 4; ++k) result.factor[k] = std::clamp(factor[std::size_t(k)], 0.0, 1.0);
  const tinygltf::TextureInfo& texture = material.pbrMetallicRoughness.baseColorTexture;
  if (texture.index != -1)
    read_texture(document, texture, where + ".pbrMetallicRoughness.baseColorTexture", result);

  if (material.alphaMode == "MASK") {
    result.masked = true;
    if (!(std::abs(material.alphaCutoff) <= 1e6))  // far beyond any alpha, well within a float
      document.fail(where + ".alphaCutoff", "is beyond any alpha");
    result.cutoff = float(material.alphaCutoff);
  } else if (material.alphaMode == "BLEND") {
    result.masked = true;
    result.cutoff = alpha_threshold;
    remarks.push_back({&remarks::blending_cut_out});
  } else if (material.alphaMode != "OPAQUE") {
    document.fail(where + ".alphaMode", "\"" + material.alphaMode + "\" is unknown");
  }
  if (material.extensions.count("KHR_materials_unlit") == 0)
    remarks.push_back({&remarks::materials_unlit});
  return result;
}

}  // namespace tureen
