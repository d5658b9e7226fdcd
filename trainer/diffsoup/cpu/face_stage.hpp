// The last stage of a step: each face sums its gradient from what the tiles of all images listed
// for it, and the optimiser steps it immediately. Only one task handles a face. Therefore additions
// are not atomic, sums are not stored, and the result does not depend on the number of threads.
#pragma once

#include <span>
#include <vector>

#include "trainer/common/kernels/adam.hpp"
#include "trainer/diffsoup/cpu/batch_image.hpp"
#include "trainer/diffsoup/cpu/texture_store.hpp"
#include "trainer/diffsoup/state.hpp"

namespace tureen::trainer {

/// The common data of all faces in a step.
struct FaceStep {
  std::span<const BatchImage> images;
  const Pyramid* pyramid;
  Model* model;
  Moments* moments;
  TextureStore* store;
  std::vector<float>* errors;  // one per face, added to
  float texture_rate, vertex_rate;
  float beta1, beta2, epsilon;
  std::size_t fixed_faces = 0;  // the corners of the first faces stay
  bool dense_updates;           // also step faces that no image touched
};

/// Reused from face to face.
struct FaceScratch {
  std::vector<Texel> gradient;  // [fine texel], by the features
  std::vector<float> alpha;     // [fine texel], by the logit of alpha
  std::vector<float> levels;    // [texel of all levels][channels]
  std::vector<float> refine;    // [fine texel][channels]
  explicit FaceScratch(const Pyramid& pyramid);
};

/// Loads a face's data in all images into the cache, while other faces are stepped.
void prefetch_face(std::span<const BatchImage> images, std::size_t face);

/// Gathers the gradient, steps the face and refreshes its texture. Returns the number of skipped
/// updates because of gradients that are not finite: 1 for the texture plus 1 for the corners.
unsigned step_face(const FaceStep& step, std::size_t face, FaceScratch& scratch);

/// Sums the levels of one face into the store.
void refresh_texture(const Pyramid& pyramid, const Model& model, std::size_t face,
                     TextureStore& store, FaceScratch& scratch);

}  // namespace tureen::trainer
