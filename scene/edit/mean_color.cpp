#include "scene/edit/mean_color.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "scene/edit/mean_mlp.hpp"
#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

glm::vec3 clamped(const glm::vec3& c) {
  const auto clamp = [](float v) { return v > 0.0f ? std::min(v, 1.0f) : 0.0f; };  // NaN: 0
  return {clamp(c.x), clamp(c.y), clamp(c.z)};
}

/// Barycentrics of the centroids in a subdivision of a face into 16 congruent triangles.
std::vector<glm::vec3> subdivision_centroids() {
  constexpr int n = 4;
  std::vector<glm::vec3> points;
  for (int x = 0; x < n; ++x)
    for (int y = 0; x + y < n; ++y)
      for (const float third : {1.0f / 3.0f, 2.0f / 3.0f}) {
        if (third > 0.5f && x + y + 1 >= n) continue;  // the second triangle lies outside the face
        const float b0 = (float(x) + third) / n, b1 = (float(y) + third) / n;
        points.emplace_back(b0, b1, 1.0f - b0 - b1);
      }
  return points;
}

/// The mean over the visible points, or over all points if none is visible.
struct VisibleMean {
  glm::vec3 seen{0.0f}, all{0.0f};
  float seen_weight = 0.0f, all_weight = 0.0f;

  void add(const glm::vec3& color, float weight, bool visible) {
    all += weight * color;
    all_weight += weight;
    if (!visible) return;
    seen += weight * color;
    seen_weight += weight;
  }
  glm::vec3 mean() const { return seen_weight > 0.0f ? seen / seen_weight : all / all_weight; }
};

struct MeanColors {
  const TriangleSoup& soup;

  using Colors = std::vector<glm::vec3>;
  Colors black() const { return Colors(soup.triangles.size(), glm::vec3(0.0f)); }

  Colors operator()(const FaceColors& colors) const {
    Colors result = black();
    for (std::size_t t = 0; t < result.size(); ++t) result[t] = clamped(glm::vec3(colors.rgba[t]));
    return result;
  }

  Colors operator()(const VertexColors& colors) const {
    Colors result = black();
    const std::vector<glm::vec3> points = subdivision_centroids();
    for (std::size_t t = 0; t < result.size(); ++t) {
      const glm::uvec3 v = soup.triangles[t];
      const glm::vec4 &a = colors.rgba[v.x], &b = colors.rgba[v.y], &c = colors.rgba[v.z];
      if (std::min({a.w, b.w, c.w}) >= alpha_threshold) {
        result[t] = clamped(glm::vec3(a + b + c) / 3.0f);
        continue;
      }
      VisibleMean mean;
      for (const glm::vec3& p : points) {
        const glm::vec4 rgba = p.x * a + p.y * b + p.z * c;
        mean.add(clamped(glm::vec3(rgba)), 1.0f, rgba.w >= alpha_threshold);
      }
      result[t] = mean.mean();
    }
    return result;
  }

  Colors operator()(const Harmonics& sh) const {
    const int count = harmonics::count(sh.degree);
    std::array<WeightedDirection, 26> rule = lebedev26();
    std::array<std::array<float, 25>, 26> bases;
    for (std::size_t i = 0; i < rule.size(); ++i) bases[i] = harmonics::basis(rule[i].d);
    const std::size_t directions = sh.degree == 0 ? 1 : rule.size();
    if (directions == 1) rule[0].weight = 1.0f;

    const bool per_face = sh.domain == Harmonics::Domain::face;
    Colors element(per_face ? soup.triangles.size() : soup.positions.size(), glm::vec3(0.0f));
    for (std::size_t e = 0; e < element.size(); ++e) {
      const glm::vec3* c = &sh.coefficients[e * count];
      for (std::size_t i = 0; i < directions; ++i) {
        glm::vec3 color(0.5f);
        for (int k = 0; k < count; ++k) color += bases[i][k] * c[k];
        element[e] += rule[i].weight * clamped(color);
      }
    }
    if (per_face) return element;
    Colors result = black();
    for (std::size_t t = 0; t < result.size(); ++t) {
      const glm::uvec3 v = soup.triangles[t];
      result[t] = (element[v.x] + element[v.y] + element[v.z]) / 3.0f;
    }
    return result;
  }

  Colors operator()(const LatticeTexture& texture) const {
    // A texel's weight: the integral of its hat function, in units of a third of a lattice
    // triangle's area. This equals the number of triangles at the texel.
    std::array<std::vector<float>, lattice::max_level + 1> areas;
    for (int level = 0; level <= lattice::max_level; ++level) {
      const int n = lattice::resolution(level);
      areas[level].resize(lattice::texel_count(level));
      for (std::uint32_t i = 0; i < areas[level].size(); ++i) {
        const auto [x, y] = lattice::texel_coordinates(i);
        const int borders = int(x == 0) + int(y == 0) + int(x + y == n);
        areas[level][i] = borders == 0 ? 6.0f : borders == 1 ? 3.0f : 1.0f;
      }
    }
    std::optional<MeanMlp> mlp;
    if (texture.mlp) mlp.emplace(*texture.mlp);

    Colors result = black();
    std::vector<std::uint32_t> chosen;
    for (std::size_t t = 0; t < result.size(); ++t) {
      const LatticePatch& patch = texture.patches[t];
      const std::uint32_t texels = lattice::texel_count(int(patch.level));
      chosen.clear();
      for (std::uint32_t i = 0; i < texels; ++i)
        if (texture.value(patch.first_texel + std::size_t(i), LatticeTexture::features) >=
            alpha_threshold)
          chosen.push_back(i);
      if (chosen.empty())
        for (std::uint32_t i = 0; i < texels; ++i) chosen.push_back(i);
      if (mlp && chosen.size() > std::size_t(mlp_samples)) {
        const std::size_t n = chosen.size();
        for (std::size_t k = 0; k < std::size_t(mlp_samples); ++k)
          chosen[k] = chosen[(2 * k + 1) * n / (2 * mlp_samples)];
        chosen.resize(mlp_samples);
      }
      VisibleMean mean;
      for (const std::uint32_t i : chosen) {
        std::array<float, 8> f;
        for (int c = 0; c < LatticeTexture::channels; ++c)
          f[c] = texture.value(patch.first_texel + std::size_t(i), c);
        mean.add(clamped(mlp ? (*mlp)(f) : glm::vec3(f[0], f[1], f[2])), areas[patch.level][i],
                 true);
      }
      result[t] = mean.mean();
    }
    return result;
  }

  Colors operator()(const UvTextures& textures) const {
    const std::vector<glm::vec3> points = subdivision_centroids();
    std::optional<MeanMlp> mlp;
    if (textures.mlp) mlp.emplace(*textures.mlp);
    Colors result = black();
    for (std::size_t t = 0; t < result.size(); ++t) {
      const UvMaterial& material = textures.materials[textures.material_of_face[t]];
      const glm::uvec3 v = soup.triangles[t];
      VisibleMean mean;
      for (const glm::vec3& p : points) {
        const glm::vec2 uv =
            p.x * textures.uv[v.x] + p.y * textures.uv[v.y] + p.z * textures.uv[v.z];
        glm::vec4 first(1.0f), second(0.0f);
        if (!material.images.empty()) first = texel(textures, material, 0, uv);
        if (mlp) second = texel(textures, material, 1, uv);
        if (!mlp) first *= material.factor;
        if (!textures.vertex_rgba.empty())
          first *= p.x * textures.vertex_rgba[v.x] + p.y * textures.vertex_rgba[v.y] +
                   p.z * textures.vertex_rgba[v.z];
        const bool visible = !(first[material.mask_channel] < material.mask_threshold);
        const glm::vec3 color = mlp ? (*mlp)({first.x, first.y, first.z, first.w, second.x,
                                              second.y, second.z, second.w})
                                    : glm::vec3(first);
        mean.add(clamped(color), 1.0f, visible);
      }
      result[t] = mean.mean();
    }
    return result;
  }

  static glm::vec4 texel(const UvTextures& textures, const UvMaterial& material, int which,
                         glm::vec2 uv) {
    const Image8& image = textures.images[material.images[which]];
    return glm::vec4(image.at(texel_index(uv.x, image.width, material.wrap_u),
                              texel_index(uv.y, image.height, material.wrap_v))) /
           255.0f;
  }

  /// The nearest texel; the first for a coordinate that is not finite.
  static int texel_index(float coordinate, int size, UvMaterial::Wrap wrap) {
    if (!std::isfinite(coordinate)) return 0;
    float u = coordinate;
    if (wrap == UvMaterial::Wrap::repeat) u -= std::floor(u);
    if (wrap == UvMaterial::Wrap::mirror)
      u = 1.0f - std::abs(u - 2.0f * std::floor(u / 2.0f) - 1.0f);
    // Clamped before the cast, since casting a float outside int's range is undefined.
    return int(std::clamp(std::floor(u * float(size)), 0.0f, float(size - 1)));
  }
};

}  // namespace

std::vector<glm::vec3> mean_colors(const TriangleSoup& soup) {
  return std::visit(MeanColors{soup}, soup.appearance);
}

}  // namespace tureen
