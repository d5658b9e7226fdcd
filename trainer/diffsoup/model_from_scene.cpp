// from_scene: converts any soup to a model for further training.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "scene/edit/mean_color.hpp"
#include "trainer/diffsoup/levels.hpp"
#include "trainer/diffsoup/mlp_parameters.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

namespace {

/// Minimum distance of values from 0 and 1: see from_scene.
constexpr double value_margin = 1e-4;

/// The logit of the blend between base colour and an untrained network. It gives the network a
/// weight of 0.12, so the first image is close to the scene.
constexpr float quiet_blend = -2.0f;

float logit(double value) {
  value = std::clamp(value, value_margin, 1 - value_margin);
  return static_cast<float>(std::log(value / (1 - value)));
}

/// Writes the logits of one face at the texels of `level`.
class FaceLogits {
 public:
  FaceLogits(const TriangleSoup& soup, int level, bool keeps_features)
      : soup_(soup), level_(level), keeps_features_(keeps_features) {
    const bool has_own_detail = std::holds_alternative<LatticeTexture>(soup.appearance) ||
                                std::holds_alternative<VertexColors>(soup.appearance);
    const auto* texture = std::get_if<LatticeTexture>(&soup.appearance);
    // Features of a network with another shape are not colours.
    if (!has_own_detail || (texture && texture->mlp && !keeps_features))
      colors_ = mean_colors(soup);
  }

  void operator()(std::size_t face, std::span<float> out) const {
    const double step = 1.0 / lattice::resolution(level_);
    for (std::uint32_t texel = 0; texel < lattice::texel_count(level_); ++texel) {
      const auto [x, y] = lattice::texel_coordinates(texel);
      write(face, x * step, y * step, out.subspan(std::size_t(texel) * channels, channels));
    }
  }

 private:
  void write(std::size_t face, double b0, double b1, std::span<float> out) const {
    std::ranges::fill(out, 0.0f);
    if (!keeps_features_) {
      set_color(color(face, b0, b1), out);
      out[blend_channel] = quiet_blend;
    }
    const auto* texture = std::get_if<LatticeTexture>(&soup_.appearance);
    if (!texture) return;
    for (int c = keeps_features_ ? 0 : alpha_channel; c < channels; ++c)
      out[c] = logit(sampled(*texture, face, b0, b1, c));
  }

  static void set_color(glm::dvec3 color, std::span<float> out) {
    for (int c = 0; c < 3; ++c) out[c] = logit(color[c]);
  }

  static double sampled(const LatticeTexture& texture, std::size_t face, double b0, double b1,
                        int channel) {
    const LatticePatch& patch = texture.patches[face];
    const auto at = lattice::footprint(static_cast<int>(patch.level), b0, b1);
    double values[3];
    for (int k = 0; k < 3; ++k)
      values[k] = double(texture.value(patch.first_texel + at.texels[k], channel));
    return lattice::interpolated(at.weights, values[0], values[1], values[2]);
  }

  glm::dvec3 color(std::size_t face, double b0, double b1) const {
    if (!colors_.empty()) return colors_[face];
    if (const auto* texture = std::get_if<LatticeTexture>(&soup_.appearance))
      return {sampled(*texture, face, b0, b1, 0), sampled(*texture, face, b0, b1, 1),
              sampled(*texture, face, b0, b1, 2)};
    const auto& rgba = std::get<VertexColors>(soup_.appearance).rgba;
    const glm::uvec3 corners = soup_.triangles[face];
    return b0 * glm::dvec3(rgba[corners[0]]) + b1 * glm::dvec3(rgba[corners[1]]) +
           (1 - b0 - b1) * glm::dvec3(rgba[corners[2]]);
  }

  const TriangleSoup& soup_;
  int level_;
  bool keeps_features_;
  std::vector<glm::vec3> colors_;  // one per face, or empty if the texture has finer detail
};

}  // namespace

Model from_scene(Scene scene, const FromScene& options) {
  make_opaque(scene);
  const TriangleSoup& soup = only_soup(scene);
  if (soup.triangles.empty()) throw InputError({}, "the initial scene has no triangle");
  Model model{.min_level = options.min_level,
              .max_level = options.max_level,
              .positions = {},
              .logits = {},
              .mlp = {},
              .origin = origin_of(only_layer(scene))};

  const Bounds box = bounds(soup);
  const glm::dvec3 center = box.center();
  const glm::dvec3 shift = glm::length(center) > 2 * box.radius() ? center : glm::dvec3(0.0);
  model.origin += shift;
  model.positions.reserve(3 * soup.triangles.size());
  for (const glm::uvec3 triangle : soup.triangles)
    for (int corner = 0; corner < 3; ++corner)
      model.positions.emplace_back(glm::dvec3(soup.positions[triangle[corner]]) - shift);

  std::optional<MlpParameters> mlp;
  if (const auto* texture = std::get_if<LatticeTexture>(&soup.appearance))
    if (texture->mlp) mlp = parameters_of(*texture->mlp);
  model.mlp = mlp ? *mlp : initial_mlp(options.seed);

  model.logits.resize(model.faces() * model.texels() * channels);
  const FaceLogits write(soup, options.max_level, mlp.has_value());
  std::vector<float> fine(std::size_t(lattice::texel_count(options.max_level)) * channels);
  for (std::size_t face = 0; face < model.faces(); ++face) {
    write(face, fine);
    levels::decompose(options.min_level, options.max_level, channels, fine,
                      model.face_logits(face));
  }
  return model;
}

}  // namespace tureen::trainer
