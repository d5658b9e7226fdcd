#include "scene/edit/mean_mlp.hpp"

#include <cmath>
#include <cstdlib>
#include <vector>

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
