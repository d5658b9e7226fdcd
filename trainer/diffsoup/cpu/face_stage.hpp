// The last stage of a step: each face gathers what all images of the batch have for it, and is
// stepped by the optimiser at once. A face is one task's alone, so nothing is added atomically, no
// gradient is ever stored, and the result does not depend on the number of threads.
#pragma once

#include <span>
#include <vector>

#include "trainer/common/kernels/adam.hpp"
#include "trainer/diffsoup/cpu/batch_image.hpp"
#include "trainer/diffsoup/cpu/texture_store.hpp"
#include "trainer/diffsoup/state.hpp"

namespace tureen::trainer {

/// What all faces of a step share.
struct FaceStep {
  std::span<const BatchImage> images;
  const Pyramid* pyramid;
  Model* model;
  Moments* moments;
  TextureStore* store;
  std::vector<float>* errors;  // one a face, added to
  float texture_rate, vertex_rate;
  float beta1, beta2, epsilon;
  float slide;         // scale of the texture slide, kernels/edge_gradient.hpp
  bool dense_updates;  // step faces that no image touched, too
};

/// Reused from face to face.
struct FaceScratch {
  std::vector<float> gradient;  // [fine texel][channels], by the features
  std::vector<float> alpha;     // [fine texel], by the logit of alpha
  std::vector<float> levels;    // [texel of all levels][channels]
  std::vector<float> refine;    // [fine texel][channels]
  explicit FaceScratch(const Pyramid& pyramid);
};

/// Gathers, steps and makes the texture anew. Returns how many numbers were not finite and so
/// left out: 0, or 1 for the texture and 1 for the corners.
unsigned step_face(const FaceStep& step, std::size_t face, FaceScratch& scratch);

/// Sums the levels of one face into the store.
void refresh_texture(const Pyramid& pyramid, const Model& model, std::size_t face,
                     TextureStore& store, FaceScratch& scratch);

}  // namespace tureen::trainer
