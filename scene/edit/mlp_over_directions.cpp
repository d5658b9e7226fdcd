#include "scene/edit/mlp_over_directions.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "scene/spherical_harmonics.hpp"

namespace tureen {

MlpOverDirections::MlpOverDirections(const ColorMlp& mlp, std::span<const glm::vec3> to_eye)
    : mlp_(mlp), count_(int(to_eye.size())), direction_part_(mlp.layers.front().outputs) {
  assert(count_ <= max_directions);
  const DenseLayer& first = mlp.layers.front();
  const int features = mlp.feature_count();
  for (int i = 0; i < count_; ++i) {
    const glm::vec3 d = mlp.view == ViewConvention::surface_to_eye ? to_eye[i] : -to_eye[i];
    std::array<float, 9> code{d.x, d.y, d.z};
    if (mlp.encoding == DirectionEncoding::harmonics2) {
      const auto basis = harmonics::basis(d);
      std::copy_n(basis.begin(), 9, code.begin());
    }
    for (int o = 0; o < first.outputs; ++o) {
      float sum = first.biases[o];
      for (int k = features; k < first.inputs; ++k)
        sum += first.weights[std::size_t(o) * first.inputs + k] * code[k - features];
      direction_part_[o][i] = sum;
    }
  }
}

void MlpOverDirections::predict(std::span<const float> features,
                                std::span<glm::vec3> colors) const {
  const DenseLayer& first = mlp_.layers.front();
  // The inner loops run over directions and vectorise. Entries after the last direction begin at
  // zero and are not used.
  std::array<OfDirections, ColorMlp::max_width> activations[2];
  auto* x = &activations[0];
  auto* y = &activations[1];
  for (int o = 0; o < first.outputs; ++o) {
    float shared = 0;
    for (int k = 0; k < mlp_.feature_count(); ++k)
      shared += first.weights[std::size_t(o) * first.inputs + k] * features[k];
    for (int i = 0; i < max_directions; ++i) (*x)[o][i] = shared + direction_part_[o][i];
  }
  for (std::size_t l = 1; l < mlp_.layers.size(); ++l) {
    const DenseLayer& layer = mlp_.layers[l];
    for (int k = 0; k < layer.inputs; ++k)
      for (float& value : (*x)[k]) value = std::max(value, 0.0f);
    for (int o = 0; o < layer.outputs; ++o) {
      OfDirections& sum = (*y)[o];
      sum.fill(layer.biases[o]);
      for (int k = 0; k < layer.inputs; ++k) {
        const float weight = layer.weights[std::size_t(o) * layer.inputs + k];
        for (int i = 0; i < max_directions; ++i) sum[i] += weight * (*x)[k][i];
      }
    }
    std::swap(x, y);
  }
  const auto sigmoid = [](float v) { return 1.0f / (1.0f + std::exp(-v)); };
  for (int i = 0; i < count_; ++i)
    colors[i] = glm::vec3(sigmoid((*x)[0][i]), sigmoid((*x)[1][i]), sigmoid((*x)[2][i]));
}

}  // namespace tureen
