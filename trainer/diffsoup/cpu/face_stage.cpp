#include "trainer/diffsoup/cpu/face_stage.hpp"

#include <algorithm>

#include "scene/triangle_soup.hpp"
#include "trainer/common/cpu/vector_clones.hpp"
#include "trainer/common/kernels/pack.hpp"
#include "trainer/common/kernels/score.hpp"
#include "trainer/diffsoup/kernels/texel_pack.hpp"

namespace tureen::trainer {

namespace {

/// The gradient of a face, summed over the images.
struct Gathered {
  float corners[3][3] = {};  // by the positions, world axes
  float error = 0;
  bool touched = false;
};

[[gnu::always_inline]] inline void gather_image(const FaceStep& step, const BatchImage& image,
                                                std::size_t index, FaceScratch& scratch,
                                                Gathered& out) {
  const int level = step.pyramid->max_level();
  const float* alpha = &step.store->alpha[index * step.pyramid->fine_texels()];
  float corners[3][3] = {};  // right, down, forward
  for (std::uint32_t i = image.tiles_begin[index]; i < image.tiles_begin[index + 1]; ++i) {
    const TileFace& tile = image.tiles_of_faces[i];
    const CornerGradient& in_tile = image.corner_gradient[tile.entry];
    out.touched = true;
    out.error += in_tile.error;
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j) corners[k][j] += in_tile.corners[k][j];
    const Texel* by_features = image.by_features[tile.tile].data() + tile.visible_begin;
    for (const GradientFragment& fragment : image.fragments_of(tile)) {
      const auto at = lattice::footprint(level, fragment.b0, fragment.b1);
      const float a = lattice::interpolated(at, alpha);
      const auto role =
          fragment.visible ? kernels::FragmentRole::winner : kernels::FragmentRole::in_front;
      for (int j = 0; j < 3; ++j)
        scratch.alpha[at.texels[j]] +=
            fragment.depth_or_factor *
            kernels::logit_score(role, a, at.weights[j], alpha[at.texels[j]]);
      if (!fragment.visible) continue;
      const kernels::TexelPack by_feature = kernels::load_texel((by_features++)->values);
      for (int j = 0; j < 3; ++j) {
        float* texel = scratch.gradient[at.texels[j]].values;
        kernels::store_texel(texel, kernels::load_texel(texel) + at.weights[j] * by_feature);
      }
    }
  }
  const kernels::View& view = image.view;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      out.corners[i][j] += corners[i][0] * float(view.right[j]) +
                           corners[i][1] * float(view.down[j]) +
                           corners[i][2] * float(view.forward[j]);
}

/// Multiplies the feature gradients by the sigmoid's derivative, and writes the score to the alpha
/// channel. The score is already a derivative by the logit.
[[gnu::always_inline]] inline void through_sigmoid(const float* values, std::size_t texels,
                                                   FaceScratch& scratch) {
  for (std::size_t i = 0; i < texels; ++i) {
    float* gradient = scratch.gradient[i].values;
    const kernels::TexelPack v = kernels::load_texel(values + i * channels);
    kernels::TexelPack g = kernels::load_texel(gradient) * v * (1.0f - v);
    g[alpha_channel] = scratch.alpha[i];
    kernels::store_texel(gradient, g);
  }
}

/// Whether all values and the sum of three squares (a second moment) are finite. x * 0 is NaN if x
/// is not finite, and the sum keeps the NaN. An infinite second moment would stop its parameter for
/// the rest of the run.
[[gnu::always_inline]] inline bool all_finite(const float* values, std::size_t count) {
  float sums[16] = {};
  std::size_t i = 0;
  for (; i + 16 <= count; i += 16)
    for (std::size_t l = 0; l < 16; ++l) sums[l] += 4 * values[i + l] * values[i + l] * 0.0f;
  for (; i < count; ++i) sums[0] += 4 * values[i] * values[i] * 0.0f;
  for (float s : sums)
    if (!(s == 0.0f)) return false;
  return true;
}

[[gnu::always_inline]] inline void refresh(const Pyramid& pyramid, const Model& model,
                                           std::size_t face, TextureStore& store,
                                           FaceScratch& scratch) {
  const std::size_t fine = pyramid.fine_texels();
  float* values = store.values[face * fine].values;
  pyramid.sum(&model.logits[face * pyramid.texels() * channels], values, scratch.refine.data());
  for (std::size_t i = 0; i < fine * channels; ++i) values[i] = kernels::sigmoid(values[i]);
  float* alpha = &store.alpha[face * fine];
  for (std::size_t i = 0; i < fine; ++i) alpha[i] = values[i * channels + alpha_channel];
}

}  // namespace

FaceScratch::FaceScratch(const Pyramid& pyramid)
    : gradient(pyramid.fine_texels()),
      alpha(pyramid.fine_texels()),
      levels(std::size_t(pyramid.texels()) * channels),
      refine(std::size_t(pyramid.fine_texels()) * channels) {}

TUREEN_VECTOR_CLONES TUREEN_FLATTEN void refresh_texture(const Pyramid& pyramid, const Model& model,
                                                         std::size_t face, TextureStore& store,
                                                         FaceScratch& scratch) {
  refresh(pyramid, model, face, store, scratch);
}

void prefetch_face(std::span<const BatchImage> images, std::size_t face) {
  for (const BatchImage& image : images)
    for (std::uint32_t i = image.tiles_begin[face]; i < image.tiles_begin[face + 1]; ++i) {
      const TileFace& tile = image.tiles_of_faces[i];
      __builtin_prefetch(&image.corner_gradient[tile.entry]);
      __builtin_prefetch(&image.fragments[tile.tile][tile.begin]);
      __builtin_prefetch(image.by_features[tile.tile].data() + tile.visible_begin);
    }
}

TUREEN_VECTOR_CLONES TUREEN_FLATTEN unsigned step_face(const FaceStep& step, std::size_t face,
                                                       FaceScratch& scratch) {
  const Pyramid& pyramid = *step.pyramid;
  std::fill(scratch.gradient.begin(), scratch.gradient.end(), Texel{});
  std::fill(scratch.alpha.begin(), scratch.alpha.end(), 0.0f);
  Gathered gathered;
  for (const BatchImage& image : step.images)
    if (image.tiles_begin[face] < image.tiles_begin[face + 1])
      gather_image(step, image, face, scratch, gathered);
  if (!gathered.touched && !step.dense_updates) return 0;

  (*step.errors)[face] += gathered.error;
  Moments& moments = *step.moments;
  const double t = ++moments.steps[face];
  const std::size_t fine = pyramid.fine_texels(), count = pyramid.texels() * std::size_t(channels);
  unsigned quarantined = 0;
  through_sigmoid(step.store->values[face * fine].values, fine, scratch);
  pyramid.scatter(scratch.gradient.data()->values, scratch.levels.data());
  if (all_finite(scratch.levels.data(), count)) {
    const kernels::AdamStep adam =
        kernels::adam_step(step.texture_rate, step.beta1, step.beta2, step.epsilon, t);
    float* values = &step.model->logits[face * count];
    float* first = &moments.first[face * count];
    float* second = &moments.second[face * count];
    const float* gradient = scratch.levels.data();
    for (std::size_t i = 0; i < count; ++i)
      kernels::adam(adam, gradient[i], values[i], first[i], second[i]);
    refresh(pyramid, *step.model, face, *step.store, scratch);
  } else {
    ++quarantined;
  }
  if (face < step.fixed_faces) return quarantined;
  if (all_finite(&gathered.corners[0][0], 9)) {
    const kernels::AdamStep adam =
        kernels::adam_step(step.vertex_rate, step.beta1, step.beta2, step.epsilon, t);
    for (std::size_t i = 0; i < 3; ++i)
      kernels::vector_adam(adam, gathered.corners[i], &step.model->positions[3 * face + i].x,
                           &moments.vertex_first[3 * face + i].x,
                           moments.vertex_second[3 * face + i]);
  } else {
    ++quarantined;
  }
  return quarantined;
}

}  // namespace tureen::trainer
