// A color MLP as a shader function. All generated GLSL is here.
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <string>
#include <vector>

#include "scene/color_mlp.hpp"

namespace tureen {

/// The range of each feature over a scene, for the interval bound that detects dead neurons.
struct FeatureRange {
  float low = 0.0f;
  float high = 1.0f;
};
using FeatureRanges = std::array<FeatureRange, 8>;

/// The form of the weights in the shader. Measured on llvmpipe at 1280x720 over the full screen
/// with DiffSoup's network: literal constants 15 ms, mat4 uniforms 97 ms.
enum class MlpWeights {
  uniforms,
  /// Constants for the neurons that may fire, without zero weights. Inputs with a single value are
  /// folded into the bias.
  constants,
  all_constants,  // for every neuron and input
};

struct ColorMlpSource {
  /// Defines `vec3 color_mlp(vec4 features0, vec4 features1, vec3 to_eye)`; HARMONICS_DEGREE must
  /// be 2 or absent. #includes harmonics.glsl if the encoding needs it.
  std::string text;
  /// For `uniform mat4 mlp_weights[]` and `uniform vec4 mlp_biases[]`; empty for constants.
  std::vector<glm::mat4> weights;
  std::vector<glm::vec4> biases;
  int hidden_neurons = 0;
  int dead_neurons = 0;  // not computed: their input is at most 0 over all features and directions
  int zero_weights = 0;  // not computed, in live neurons
  bool reads_features1 = true;  // whether color_mlp() uses its second argument
};

ColorMlpSource color_mlp_source(const ColorMlp& mlp, MlpWeights kind,
                                const FeatureRanges& ranges = {});

}  // namespace tureen
