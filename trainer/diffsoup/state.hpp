// Everything that a training run has learned, and all that the next step needs: a checkpoint is
// this and nothing else.
#pragma once

#include <cstdint>
#include <vector>

#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

/// Adam's moments of everything in a Model, in its layout.
struct Moments {
  std::vector<float> first, second;     // of the logits
  std::vector<glm::vec3> vertex_first;  // of the positions
  std::vector<float> vertex_second;     // one a vertex: VectorAdam
  std::vector<std::uint32_t> steps;     // one a face: how often it was stepped
  MlpParameters mlp_first{}, mlp_second{};
  std::uint32_t mlp_steps = 0;

  /// Zeros for all faces of `model`; what belongs to the MLP stays.
  void reset_faces(const Model& model);
};

struct TrainingState {
  Model model;
  Moments moments;
  int step = 0;  // steps done
  /// The error that each face showed since the last resampling: the sum over its pixels and their
  /// channels of |C - G|. Empty: none yet.
  std::vector<float> errors;
  /// Running mean of the score's loss, a pixel of each training image in its order, image after
  /// image, stored as round(65535 sqrt(l / 3)); empty without a baseline.
  std::vector<std::uint16_t> baseline;
  std::uint64_t non_finite = 0;  // pixels and parameters that were quarantined so far
};

/// Puts numbers in the place of what is none, as a mesh to begin with may bring it: 0 for logits
/// and weights, and of a face with a corner that is none all three become the origin, a face that
/// no image shows. Left as they are they would never learn: what is no number has no gradient
/// that is one. Moments of what was replaced begin again. Returns how many numbers were replaced,
/// and adds them to non_finite.
std::uint64_t quarantine(TrainingState& state);

}  // namespace tureen::trainer
