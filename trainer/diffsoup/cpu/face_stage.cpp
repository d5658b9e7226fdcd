#include "trainer/diffsoup/cpu/face_stage.hpp"

#include <algorithm>
#include <cmath>

#include "scene/triangle_soup.hpp"
#include "trainer/common/cpu/vector_clones.hpp"
#include "trainer/common/kernels/edge_gradient.hpp"
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

[[gnu::always_inline]] inline kernels::EdgePixel edge_pixel(const BatchImage& image,
                                                            std::size_t pixel) {
  const PixelGradient& gradient = image.gradient[pixel];
  kernels::EdgePixel result;
  result.face = image.visible[pixel].face;
  result.inverse_depth = image.visible[pixel].inverse_depth;
  for (int c = 0; c < 3; ++c) {
    result.color[c] = gradient.color[c];
    result.gradient[c] = gradient.by_color[c];
  }
  return result;
}

/// Adds the gradients from the four edges of a pixel that shows the face.
[[gnu::always_inline]] inline void gather_edges(const BatchImage& image,
                                                const kernels::ProjectedFace& face, int x, int y,
                                                std::size_t pixel, float slide,
                                                float (&corners)[3][3]) {
  const kernels::EdgePixel p = edge_pixel(image, pixel);
  const int width = image.view.width, height = image.view.height;
  const int neighbours[4][2] = {{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}};
  for (const auto& n : neighbours) {
    if (n[0] < 0 || n[1] < 0 || n[0] >= width || n[1] >= height) continue;
    const kernels::EdgePixel q = edge_pixel(image, std::size_t(n[1]) * width + n[0]);
    const bool background = q.face == no_face;
    const kernels::ProjectedFace* other = background ? nullptr : &image.projected[q.face];
    const kernels::PointGradient point =
        kernels::edge_gradient(face, other, x, y, n[0], n[1], p, q, background, slide);
    if (point.kind != kernels::EdgeCase::none)
      kernels::distribute(image.view, face, point, corners);
  }
}

[[gnu::always_inline]] inline void gather_image(const FaceStep& step, const BatchImage& image,
                                                std::size_t index, FaceScratch& scratch,
                                                Gathered& out) {
  const kernels::ProjectedFace& face = image.projected[index];
  const std::size_t width = std::size_t(image.view.width);
  const int level = step.pyramid->max_level();
  const float* alpha = &step.store->alpha[index * step.pyramid->fine_texels()];
  float corners[3][3] = {};  // right, down, forward
  kernels::for_each_fragment(
      image.view, face, {0, 0, image.view.width, image.view.height},
      [&](const kernels::Fragment& fragment) __attribute__((always_inline)) {
        const std::size_t pixel = std::size_t(fragment.y) * width + std::size_t(fragment.x);
        const VisiblePixel& visible = image.visible[pixel];
        const bool won = visible.face == index;
        // Behind the winner nothing depends on this face. At equal depths the lower face is in
        // front, as in find_visible.
        const bool in_front =
            fragment.inverse_depth > visible.inverse_depth ||
            (fragment.inverse_depth == visible.inverse_depth && index < visible.face);
        if (!won && !in_front) return;
        out.touched = true;
        const auto at = lattice::footprint(level, fragment.b0, fragment.b1);
        const float a = lattice::interpolated(at, alpha);
        const auto role = won ? kernels::FragmentRole::winner : kernels::FragmentRole::in_front;
        for (int j = 0; j < 3; ++j)
          scratch.alpha[at.texels[j]] +=
              image.loss[pixel] * kernels::logit_score(role, a, at.weights[j], alpha[at.texels[j]]);
        if (!won) return;
        out.error += image.gradient[pixel].error;
        const kernels::TexelPack by_features = kernels::load_texel(image.gradient[pixel].features);
        for (int j = 0; j < 3; ++j) {
          float* texel = &scratch.gradient[std::size_t(at.texels[j]) * channels];
          kernels::store_texel(texel, kernels::load_texel(texel) + at.weights[j] * by_features);
        }
        gather_edges(image, face, fragment.x, fragment.y, pixel, step.slide, corners);
      });
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
    float* gradient = &scratch.gradient[i * channels];
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
  float* values = &store.values[face * fine * channels];
  pyramid.sum(&model.logits[face * pyramid.texels() * channels], values, scratch.refine.data());
  for (std::size_t i = 0; i < fine * channels; ++i) values[i] = kernels::sigmoid(values[i]);
  float* alpha = &store.alpha[face * fine];
  for (std::size_t i = 0; i < fine; ++i) alpha[i] = values[i * channels + alpha_channel];
}

}  // namespace

FaceScratch::FaceScratch(const Pyramid& pyramid)
    : gradient(std::size_t(pyramid.fine_texels()) * channels),
      alpha(pyramid.fine_texels()),
      levels(std::size_t(pyramid.texels()) * channels),
      refine(std::size_t(pyramid.fine_texels()) * channels) {}

TUREEN_VECTOR_CLONES TUREEN_FLATTEN void refresh_texture(const Pyramid& pyramid, const Model& model,
                                                         std::size_t face, TextureStore& store,
                                                         FaceScratch& scratch) {
  refresh(pyramid, model, face, store, scratch);
}

TUREEN_VECTOR_CLONES TUREEN_FLATTEN unsigned step_face(const FaceStep& step, std::size_t face,
                                                       FaceScratch& scratch) {
  const Pyramid& pyramid = *step.pyramid;
  std::fill(scratch.gradient.begin(), scratch.gradient.end(), 0.0f);
  std::fill(scratch.alpha.begin(), scratch.alpha.end(), 0.0f);
  Gathered gathered;
  for (const BatchImage& image : step.images)
    if (image.reached[face]) gather_image(step, image, face, scratch, gathered);
  if (!gathered.touched && !step.dense_updates) return 0;

  (*step.errors)[face] += gathered.error;
  Moments& moments = *step.moments;
  const double t = ++moments.steps[face];
  const std::size_t fine = pyramid.fine_texels(), count = pyramid.texels() * std::size_t(channels);
  unsigned quarantined = 0;
  through_sigmoid(&step.store->values[face * fine * channels], fine, scratch);
  pyramid.scatter(scratch.gradient.data(), scratch.levels.data());
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
