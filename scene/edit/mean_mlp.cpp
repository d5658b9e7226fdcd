#include "scene/edit/mean_mlp.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

std::vector<glm::vec3> directions_for(const ColorMlp& mlp) {
  std::vector<glm::vec3> result;
  for (const WeightedDirection& direction : lebedev26()) result.push_back(direction.d);
  // Without a direction input, all directions give the same colour.
  if (mlp.encoding == DirectionEncoding::none) result.resize(1);
  return result;
}

}  // namespace

std::array<WeightedDirection, 26> lebedev26() {
  constexpr float axis = 1.0f / 21.0f, edge = 4.0f / 105.0f, corner = 9.0f / 280.0f;
  std::array<WeightedDirection, 26> rule{};
  std::size_t next = 0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const int nonzero = std::abs(x) + std::abs(y) + std::abs(z);
        if (nonzero == 0) continue;
        const glm::vec3 d = glm::vec3(x, y, z) / std::sqrt(float(nonzero));
        rule[next++] = {d, nonzero == 1 ? axis : nonzero == 2 ? edge : corner};
      }
  return rule;
}

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

MeanMlp::MeanMlp(const ColorMlp& mlp) : mlp_(mlp), over_(mlp, directions_for(mlp)) {}

glm::vec3 MeanMlp::operator()(const std::array<float, 8>& features) const {
  std::array<glm::vec3, 26> colors;
  over_.predict(features, colors);
  glm::vec3 sum(0.0f);
  for (std::size_t i = 0; i < std::size_t(over_.count()); ++i)
    sum += (over_.count() == 1 ? 1.0f : rule_[i].weight) * colors[i];
  if (!mlp_.blend_channel) return sum;
  const float blend = features[std::size_t(*mlp_.blend_channel)];
  return (1.0f - blend) * glm::vec3(features[0], features[1], features[2]) + blend * sum;
}

}  // namespace tureen
