#include "scene/triangle_soup.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "scene/edit/moved_normals.hpp"
#include "scene/lattice.hpp"
#include "scene/soup_arrays.hpp"

namespace tureen {

namespace {

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

using Defect = std::optional<std::string>;

struct FindDefect {
  template <class Other>
  Defect operator()(const Other&) const {
    return {};
  }

  Defect operator()(const LatticeTexture& texture) const {
    const std::size_t texels = texture.texel_count();
    for (const LatticePatch& patch : texture.patches) {
      if (patch.level > std::uint32_t(lattice::max_level))
        return "a lattice level of " + std::to_string(patch.level) + " is outside 0..7";
      if (patch.first_texel + std::size_t(lattice::texel_count(int(patch.level))) > texels)
        return "a lattice patch extends past the last of " + std::to_string(texels) + " texels";
    }
    if (texture.mlp) return tureen::defect(*texture.mlp, LatticeTexture::features);
    return {};
  }

  Defect operator()(const UvTextures& textures) const {
    for (const std::uint32_t material : textures.material_of_face)
      if (material >= textures.materials.size())
        return "material " + std::to_string(material) + " does not exist";
    for (const Image8& image : textures.images)
      if (image.width < 1 || image.height < 1 ||
          image.pixels.size() != std::size_t(image.width) * image.height)
        return std::string("a texture image is empty or has a wrong size");
    for (const UvMaterial& material : textures.materials)
      if (Defect found = defect_of(material, textures)) return found;
    if (textures.mlp && !textures.vertex_rgba.empty())
      return std::string("vertex colours cannot be combined with a color MLP");
    if (textures.mlp) return tureen::defect(*textures.mlp, 8);
    return {};
  }

  static Defect defect_of(const UvMaterial& material, const UvTextures& textures) {
    if (textures.mlp ? material.images.size() != 2 : material.images.size() > 1)
      return "a material has " + std::to_string(material.images.size()) + " images";
    for (const std::uint32_t image : material.images)
      if (image >= textures.images.size())
        return "texture image " + std::to_string(image) + " does not exist";
    if (textures.mlp) {
      const Image8& first = textures.images[material.images[0]];
      const Image8& second = textures.images[material.images[1]];
      if (first.width != second.width || first.height != second.height)
        return std::string("the two feature images of a material differ in size");
    }
    if (material.mask_channel < 0 || material.mask_channel > 3)
      return std::string("a material's mask channel is outside 0..3");
    return {};
  }
};

/// The first array with a size that does not match.
Defect size_defect(const TriangleSoup& soup) {
  Defect result;
  const auto check_for = [&](std::size_t elements) {
    return [&result, elements](const auto& values, std::size_t each, const char* name) {
      if (!result && values.size() != elements * each)
        result = std::to_string(values.size()) + " " + name + ", expected " +
                 std::to_string(elements * each);
    };
  };
  for_each_face_array(soup, check_for(soup.triangles.size()));
  for_each_vertex_array(soup, check_for(soup.positions.size()));
  return result;
}

}  // namespace

std::size_t LatticeTexture::texel_count() const {
  return std::visit([](const auto& values) { return values.size() / channels; }, texels);
}

float LatticeTexture::value(std::size_t texel, int channel) const {
  const std::size_t index = texel * channels + channel;
  if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&texels))
    return float((*bytes)[index]) / 255.0f;
  return std::get<std::vector<float>>(texels)[index];
}

std::vector<glm::uvec3> unshared_triangles(std::size_t count) {
  std::vector<glm::uvec3> triangles(count);
  for (std::size_t t = 0; t < count; ++t) triangles[t] = glm::uvec3(3 * t, 3 * t + 1, 3 * t + 2);
  return triangles;
}

double Bounds::radius() const { return 0.5 * glm::length(glm::dvec3(high) - glm::dvec3(low)); }

Bounds bounds(const TriangleSoup& soup) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Bounds box{glm::vec3(infinity), glm::vec3(-infinity)};
  for (const glm::uvec3& triangle : soup.triangles)
    for (int k = 0; k < 3; ++k) {
      const glm::vec3& p = soup.positions[triangle[k]];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) continue;
      box.low = glm::min(box.low, p);
      box.high = glm::max(box.high, p);
    }
  return box.low.x <= box.high.x ? box : Bounds{};
}

std::size_t byte_size(const TriangleSoup& soup) {
  std::size_t total = 0;
  const auto add = [&](const auto& values, std::size_t, const char*) { total += bytes_of(values); };
  for_each_vertex_array(soup, add);
  for_each_face_array(soup, add);
  if (const auto* texture = std::get_if<LatticeTexture>(&soup.appearance))
    total += std::visit([](const auto& values) { return bytes_of(values); }, texture->texels);
  if (const auto* textures = std::get_if<UvTextures>(&soup.appearance))
    for (const Image8& image : textures->images) total += bytes_of(image.pixels);
  return total;
}

const char* appearance_name(const Appearance& appearance) {
  struct Name {
    const char* operator()(const FaceColors&) const { return "face colours"; }
    const char* operator()(const VertexColors&) const { return "vertex colours"; }
    const char* operator()(const Harmonics& a) const {
      return a.domain == Harmonics::Domain::face ? "face harmonics" : "vertex harmonics";
    }
    const char* operator()(const LatticeTexture& a) const {
      return a.mlp ? "lattice texture with color MLP" : "lattice texture";
    }
    const char* operator()(const UvTextures& a) const {
      return a.mlp ? "UV feature textures with color MLP" : "UV textures";
    }
  };
  return std::visit(Name{}, appearance);
}

std::optional<std::string> defect(const TriangleSoup& soup) {
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (soup.triangles[t][k] >= soup.positions.size())
        return "face " + std::to_string(t) + " names vertex " +
               std::to_string(soup.triangles[t][k]) + " of " +
               std::to_string(soup.positions.size());
  if (const auto* sh = std::get_if<Harmonics>(&soup.appearance);
      sh && (sh->degree < 0 || sh->degree > harmonics::max_degree))
    return "harmonics of degree " + std::to_string(sh->degree) + " are outside 0..4";
  if (Defect found = size_defect(soup)) return found;
  for (std::size_t v = 0; v < soup.normals.size(); ++v)
    if (!is_unit_or_zero(soup.normals[v]))
      return "the normal of vertex " + std::to_string(v) + " has a length other than 0 and 1";
  return std::visit(FindDefect{}, soup.appearance);
}

}  // namespace tureen
