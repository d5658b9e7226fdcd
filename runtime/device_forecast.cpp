#include "runtime/device_forecast.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "runtime/passes/lattice_source.hpp"
#include "runtime/passes/texel_store.hpp"
#include "runtime/splats/device_splats.hpp"
#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

/// Sums the stores that runtime/passes/appearance_source.cpp creates for each appearance. A test
/// compares the sum with the created stores.
class Forecaster {
 public:
  Forecaster(const TriangleSoup& soup, const SoupPlan& plan) : soup_(soup), plan_(plan) {}

  DeviceForecast run() {
    result_.bytes = slots() * 3 * sizeof(glm::vec3);
    if (plan_.drops_small_triangles) result_.bytes *= 2;  // CoveredFaces keeps a copy
    std::visit([this](const auto& appearance) { count(appearance); }, soup_.appearance);
    return std::move(result_);
  }

 private:
  std::uint64_t slots() const { return plan_.faces.size(); }
  std::uint32_t vertex_of(std::uint64_t corner) const {
    return soup_.triangles[plan_.faces[corner / 3]][int(corner % 3)];
  }

  void add(const char* what, std::uint64_t texels, std::uint64_t bytes_each) {
    result_.bytes += texels * bytes_each;
    if (texels <= result_.largest_store_texels) return;
    result_.largest_store_texels = texels;
    result_.largest_store = what;
  }

  /// Four bytes a colour if that is lossless, otherwise 16, as in the upload.
  void add_colors(const char* what, std::uint64_t texels,
                  const std::function<glm::vec4(std::uint64_t)>& color) {
    const auto is_byte = [](float value) {
      return std::clamp(std::round(value * 255.0f), 0.0f, 255.0f) / 255.0f == value;
    };
    bool bytes = true;
    for (std::uint64_t i = 0; bytes && i < texels; ++i) {
      const glm::vec4 value = color(i);
      bytes = is_byte(value.r) && is_byte(value.g) && is_byte(value.b) && is_byte(value.a);
    }
    add(what, texels, bytes ? 4 : 16);
  }

  void count(const FaceColors& colors) {
    add_colors("face colours", slots(),
               [&](std::uint64_t slot) { return colors.rgba[plan_.faces[slot]]; });
  }

  void count(const VertexColors& colors) {
    const std::uint64_t each = plan_.flat_colors ? 1 : 3;
    add_colors("vertex colours", each * slots(), [&](std::uint64_t i) {
      return colors.rgba[vertex_of(plan_.flat_colors ? 3 * i : i)];
    });
  }

  void count(const Harmonics& sh) {
    const std::uint64_t elements = slots() * (sh.domain == Harmonics::Domain::vertex ? 3 : 1);
    add("harmonics", elements * std::uint64_t(harmonics::count(plan_.harmonics_degree)), 12);
    add("harmonics anchors", elements, 12);
  }

  void count(const LatticeTexture& texture) {
    if (plan_.flat_colors)
      return add_colors("face colours", slots(), [&](std::uint64_t slot) {
        const std::uint32_t texel = texture.patches[plan_.faces[slot]].first_texel;
        return glm::vec4(texture.value(texel, 0), texture.value(texel, 1), texture.value(texel, 2),
                         1.0f);
      });
    const std::uint64_t texels = lattice_texels(texture);
    const auto four_channels = std::uint64_t(texture.is_float() ? 16 : 4);
    add("lattice texels", texels, four_channels);
    if (plan_.latent_features) add("lattice texels", texels, four_channels);
    if (plan_.opaque_count < plan_.faces.size())
      plan_.lattice.alpha_by_cell ? add("lattice alpha", alpha_cells(texture), four_channels)
                                  : add("lattice alpha", texels, four_channels / 4);
    if (plan_.lattice.uniform_level < 0) add("lattice patches", slots(), 16);
  }

  /// Four alphas a cell. Faces that share texels share cells if the texels are uploaded unchanged.
  std::uint64_t alpha_cells(const LatticeTexture& texture) const {
    const LatticePlan& lattice = plan_.lattice;
    const bool repacked = lattice.uniform_level >= 0 || !lattice.levels.empty();
    std::set<std::pair<std::uint32_t, std::uint32_t>> known;
    std::uint64_t cells = 0;
    for (std::size_t slot = 0; slot < plan_.faces.size(); ++slot) {
      const LatticePatch& patch = texture.patches[plan_.faces[slot]];
      if (!repacked && !known.insert({patch.first_texel, patch.level}).second) continue;
      cells += lattice::cell_count(lattice.levels.empty() ? int(patch.level)
                                                          : int(lattice.levels[slot]));
    }
    return cells;
  }

  std::uint64_t lattice_texels(const LatticeTexture& texture) const {
    const LatticePlan& lattice = plan_.lattice;
    if (lattice.levels.empty() && lattice.uniform_level < 0) return texture.texel_count();
    std::uint64_t texels = 0;
    for (std::size_t slot = 0; slot < plan_.faces.size(); ++slot)
      texels += lattice::texel_count(lattice.levels.empty() ? lattice.uniform_level
                                                            : int(lattice.levels[slot]));
    return texels;
  }

  void count(const UvTextures& textures) {
    // Materials that share their images share the texels.
    std::set<std::vector<std::uint32_t>> known;
    std::uint64_t texels = 0;
    for (const UvMaterial& material : textures.materials)
      if (!material.images.empty() && known.insert(material.images).second)
        texels += textures.images[material.images[0]].pixels.size();
    for (int i = 0; i < (plan_.latent_features ? 2 : 1); ++i) add("texture images", texels, 4);
    add("materials", 3 * textures.materials.size(), 16);
    add("texture coordinates", 3 * slots(), 8);
    if (!textures.vertex_rgba.empty())
      add_colors("vertex colours", 3 * slots(),
                 [&](std::uint64_t corner) { return textures.vertex_rgba[vertex_of(corner)]; });
    add("face materials", slots(), 4);
  }

  const TriangleSoup& soup_;
  const SoupPlan& plan_;
  DeviceForecast result_;
};

}  // namespace

DeviceForecast device_forecast(const TriangleSoup& soup, const SoupPlan& plan) {
  return Forecaster(soup, plan).run();
}

DeviceForecast device_forecast(const Splats& splats, const SplatPlan& plan) {
  const TexelLayout layout;
  const SplatSource source = prepare_splats(splats, plan, layout);
  const TexelSource& largest =
      source.kernel.count > source.coefficients.count ? source.kernel : source.coefficients;
  return {.bytes = source.kernel.count * source.kernel.format.bytes +
                   source.coefficients.count * source.coefficients.format.bytes +
                   plan.drawn.size() * projected_bytes(plan),
          .largest_store_texels = largest.count,
          .largest_store = largest.what};
}

std::uint64_t texel_capacity(const DeviceLimits& limits) {
  return TexelLayout::of(limits).capacity();
}

}  // namespace tureen
