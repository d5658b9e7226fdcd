// The state of a training run: the trained model and the additional data for the next step. A
// checkpoint stores it.
#pragma once

#include <cstdint>
#include <vector>

#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

/// Adam's moments of everything in a Model, in its layout.
struct Moments {
  std::vector<float> first, second;     // of the logits
  std::vector<glm::vec3> vertex_first;  // of the positions
  std::vector<float> vertex_second;     // one per vertex: VectorAdam
  std::vector<std::uint32_t> steps;     // optimiser steps of each face
  MlpParameters mlp_first{}, mlp_second{};
  std::uint32_t mlp_steps = 0;

  /// Sets the moments of all faces of `model` to zero; those of the MLP do not change.
  void reset_faces(const Model& model);
};

struct TrainingState {
  Model model;
  Moments moments;
  int step = 0;  // steps done
  /// The error of each face since the last resampling: the sum of |C - G| over its pixels and their
  /// channels. Empty at the start.
  std::vector<float> errors;
  /// Running mean l of the score's loss for each pixel of each training image, image after image,
  /// stored as round(65535 sqrt(l / 3)); empty without a baseline.
  std::vector<std::uint16_t> baseline;
  std::uint64_t non_finite = 0;  // number of quarantined pixels and parameters so far
};

/// Replaces numbers that are not finite, for example from an initial mesh. Logits and weights
/// become zero. If a corner of a face is not finite, all three corners move to the origin, and no
/// image shows the face. Such numbers would never train, because their gradients are not finite
/// either. Moments of replaced numbers restart at 0. Returns the count of replaced numbers and adds
/// it to non_finite.
std::uint64_t quarantine(TrainingState& state);

}  // namespace tureen::trainer
