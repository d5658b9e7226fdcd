// Trains a color MLP on examples by Adam (Kingma and Ba, arXiv 1412.6980).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>

#include "noise.hpp"
#include "soup/color_mlp.hpp"

namespace tureen::example {

/// One pixel: what the network is given and the final colour, after the blend, that it should have.
struct Example {
  std::array<double, 7> features;
  glm::dvec3 to_eye;
  glm::dvec3 color;
};

struct TrainingOptions {
  int steps = 14000;
  int batch = 256;
  double rate = 6e-3;  // falls to a hundredth of itself along half a cosine
  std::uint64_t seed = 1;
};

struct Training {
  ColorMlp mlp;             // 16-16-16-3, harmonics of degree 2, surface to eye, blend channel 3
  double root_mean_square;  // of the final colour over the last tenth of the steps, at least one
};

Training train(const std::function<Example(Random&)>& draw, const TrainingOptions& options);

}  // namespace tureen::example
