// The one place that writes GLSL: a color MLP as a shader function.
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "scene/color_mlp.hpp"

namespace tureen {

/// The range of each feature over a scene, for the interval bound that finds dead neurons.
struct FeatureRange {
  float low = 0.0f;
  float high = 1.0f;
};
using FeatureRanges = std::array<FeatureRange, 8>;

/// How weights reach the shader. Measured on llvmpipe at 1280x720 over the full screen, DiffSoup's
/// network: literal constants 15 ms, mat4 uniforms 97 ms.
enum class MlpWeights {
  uniforms,
  /// Of the neurons that may fire, without weights of zero; inputs whose range is a single value
  /// become part of the bias.
  constants,
  all_constants,  // of every neuron and input
};

struct ColorMlpSource {
  /// Defines `vec3 color_mlp(vec4 features0, vec4 features1, vec3 to_eye)`; HARMONICS_DEGREE must
  /// be 2 or absent. #includes harmonics.glsl where the encoding wants it.
  std::string text;
  /// For `uniform mat4 mlp_weights[]` and `uniform vec4 mlp_biases[]`; empty for constants.
  std::vector<glm::mat4> weights;
  std::vector<glm::vec4> biases;
  int hidden_neurons = 0;
  int dead_neurons = 0;  // left out: their input is at most 0 over all features and directions
  int zero_weights = 0;  // left out among the neurons that live
  bool reads_features1 = true;  // whether color_mlp() looks at its second argument
};

ColorMlpSource color_mlp_source(const ColorMlp& mlp, MlpWeights kind,
                                const FeatureRanges& ranges = {});

}  // namespace tureen
