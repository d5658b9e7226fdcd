#include "trainer/diffsoup/model.hpp"

#include <cassert>
#include <limits>

#include "trainer/common/kernels/scalar.hpp"
#include "trainer/diffsoup/levels.hpp"
#include "trainer/diffsoup/mlp_parameters.hpp"

namespace tureen::trainer {

namespace {

void zero_alpha(std::span<float> logits) {
  for (std::size_t i = alpha_channel; i < logits.size(); i += channels) logits[i] = 0.0f;
}

}  // namespace

std::size_t Model::texels() const { return levels::texel_count(min_level, max_level); }

std::span<const float> Model::face_logits(std::size_t face) const {
  assert(face < faces());
  return std::span(logits).subspan(face * texels() * channels, texels() * channels);
}

std::span<float> Model::face_logits(std::size_t face) {
  assert(face < faces());
  return std::span(logits).subspan(face * texels() * channels, texels() * channels);
}

void fine_logits(const Model& model, std::size_t face, std::span<float> out) {
  levels::accumulate(model.min_level, model.max_level, channels, model.face_logits(face), out);
}

Model lifted(const Model& from, int min_level, int max_level, LiftedOpacity opacity) {
  Model to{.min_level = min_level,
           .max_level = max_level,
           .positions = from.positions,
           .logits = {},
           .mlp = from.mlp,
           .origin = from.origin};
  to.logits.resize(to.faces() * to.texels() * channels);
  // The detour over the finer of the two highest levels makes all lattices nested.
  const int through = std::max(from.max_level, max_level);
  std::vector<float> padded(levels::texel_count(from.min_level, through) * channels);
  std::vector<float> fine(std::size_t(lattice::texel_count(through)) * channels);
  std::vector<float> at_max(std::size_t(lattice::texel_count(max_level)) * channels);
  for (std::size_t face = 0; face < from.faces(); ++face) {
    std::ranges::copy(from.face_logits(face), padded.begin());
    levels::accumulate(from.min_level, through, channels, padded, fine);
    levels::coarsen(through, max_level, channels, fine, at_max);
    if (opacity == LiftedOpacity::reset) zero_alpha(at_max);
    levels::decompose(min_level, max_level, channels, at_max, to.face_logits(face));
  }
  return to;
}

void fine_texture(const Model& model, std::size_t face, std::vector<float>& out) {
  out.resize(std::size_t(lattice::texel_count(model.max_level)) * channels);
  fine_logits(model, face, out);
  for (float& value : out) value = kernels::sigmoid(value);
}

Scene to_scene(const Model& model) {
  const std::size_t texels = lattice::texel_count(model.max_level);
  assert(model.faces() * texels <= std::numeric_limits<std::uint32_t>::max());
  LatticeTexture texture;
  std::vector<float> values, face_values;
  values.reserve(model.faces() * texels * channels);
  TriangleSoup soup;
  soup.positions = model.positions;
  for (std::size_t face = 0; face < model.faces(); ++face) {
    fine_texture(model, face, face_values);
    values.insert(values.end(), face_values.begin(), face_values.end());
    texture.patches.push_back(
        {.first_texel = std::uint32_t(face * texels), .level = std::uint32_t(model.max_level)});
    const auto corner = std::uint32_t(3 * face);
    soup.triangles.emplace_back(corner, corner + 1, corner + 2);
  }
  texture.texels = std::move(values);
  texture.mlp = color_mlp(model.mlp);
  soup.appearance = std::move(texture);
  Scene scene = scene_of(std::move(soup), model.origin);
  scene.info.source = "trained by Tureen";
  return scene;
}

}  // namespace tureen::trainer
