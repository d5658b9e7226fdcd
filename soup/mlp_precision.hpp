// The color MLP with fewer bits, emulated: what it would show on a device that computes so. For
// reports of error alone; nothing draws with it.
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "soup/color_mlp.hpp"

namespace tureen {

/// Features and the encoded direction come in, and the sigmoid and the blend are done, in float;
/// between them:
enum class MlpPrecision {
  exact,         // double, sigmoid and blend too: evaluate()
  float32,       // floats
  half_weights,  // weights, biases and each layer's inputs rounded to halves, sums in float
  half,          // the sum rounded to a half after every multiply-add, too
  int8_weights,  // weights w = q scale, q in -127..127, one scale a layer; all else float
  int8,          // each layer's inputs alike, with the scale of their largest at this point
};

const char* name_of(MlpPrecision precision);

class EmulatedMlp {
 public:
  EmulatedMlp(ColorMlp mlp, MlpPrecision precision);

  /// As evaluate(mlp, features, to_eye).
  glm::dvec3 operator()(std::span<const double> features, glm::dvec3 to_eye) const;

 private:
  ColorMlp mlp_;  // its weights rounded
  MlpPrecision precision_;
};

}  // namespace tureen
