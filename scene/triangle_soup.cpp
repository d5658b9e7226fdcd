#include "scene/triangle_soup.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>

#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

std::string count_mismatch(const char* what, std::size_t have, std::size_t want) {
  return std::to_string(have) + " " + what + ", expected " + std::to_string(want);
}

using Defect = std::optional<std::string>;

struct FindDefect {
  std::size_t vertices;
  std::size_t faces;

  Defect operator()(const FaceColors& colors) const {
    if (colors.rgba.size() != faces)
      return count_mismatch("face colours", colors.rgba.size(), faces);
    return {};
  }

  Defect operator()(const VertexColors& colors) const {
    if (colors.rgba.size() != vertices)
      return count_mismatch("vertex colours", colors.rgba.size(), vertices);
    return {};
  }

  Defect operator()(const Harmonics& sh) const {
    if (sh.degree < 0 || sh.degree > harmonics::max_degree)
      return "harmonics of degree " + std::to_string(sh.degree) + " are outside 0..4";
    const std::size_t elements = sh.domain == Harmonics::Domain::face ? faces : vertices;
    const std::size_t want = elements * harmonics::count(sh.degree);
    if (sh.coefficients.size() != want)
      return count_mismatch("harmonics coefficients", sh.coefficients.size(), want);
    return {};
  }

  Defect operator()(const LatticeTexture& texture) const {
    if (texture.patches.size() != faces)
      return count_mismatch("lattice patches", texture.patches.size(), faces);
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
    if (textures.uv.size() != vertices)
      return count_mismatch("texture coordinates", textures.uv.size(), vertices);
    if (textures.material_of_face.size() != faces)
      return count_mismatch("face materials", textures.material_of_face.size(), faces);
    if (!textures.vertex_rgba.empty() && textures.vertex_rgba.size() != vertices)
      return count_mismatch("vertex colours", textures.vertex_rgba.size(), vertices);
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

struct ByteSize {
  std::size_t operator()(const FaceColors& a) const { return bytes_of(a.rgba); }
  std::size_t operator()(const VertexColors& a) const { return bytes_of(a.rgba); }
  std::size_t operator()(const Harmonics& a) const { return bytes_of(a.coefficients); }
  std::size_t operator()(const LatticeTexture& a) const {
    const auto size = [](const auto& values) { return bytes_of(values); };
    return bytes_of(a.patches) + std::visit(size, a.texels);
  }
  std::size_t operator()(const UvTextures& a) const {
    std::size_t total = bytes_of(a.uv) + bytes_of(a.material_of_face) + bytes_of(a.vertex_rgba);
    for (const Image8& image : a.images) total += bytes_of(image.pixels);
    return total;
  }
};

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
  return bytes_of(soup.positions) + bytes_of(soup.triangles) +
         std::visit(ByteSize{}, soup.appearance);
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
  return std::visit(FindDefect{soup.positions.size(), soup.triangles.size()}, soup.appearance);
}

}  // namespace tureen
