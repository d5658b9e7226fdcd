#include "trainer/diffsoup/state.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace tureen::trainer {

namespace {

/// Sets numbers that are not finite to 0 and returns their count.
std::uint64_t cleared(std::span<float> values) {
  std::uint64_t count = 0;
  for (float& value : values)
    if (!std::isfinite(value)) {
      value = 0;
      ++count;
    }
  return count;
}

/// The same for numbers and their moments. If one of the three is not finite, both moments restart
/// at 0.
std::uint64_t cleared(std::span<float> values, std::span<float> first, std::span<float> second) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::uint64_t here = cleared(values.subspan(i, 1)) + cleared(first.subspan(i, 1)) +
                               cleared(second.subspan(i, 1));
    if (here > 0) first[i] = second[i] = 0;
    count += here;
  }
  return count;
}

std::span<float> floats(std::span<glm::vec3> vectors) {
  return vectors.empty() ? std::span<float>() : std::span(&vectors[0].x, 3 * vectors.size());
}

}  // namespace

void Moments::reset_faces(const Model& model) {
  first.assign(model.logits.size(), 0.0f);
  second.assign(model.logits.size(), 0.0f);
  vertex_first.assign(model.positions.size(), glm::vec3(0));
  vertex_second.assign(model.positions.size(), 0.0f);
  steps.assign(model.faces(), 0);
}

std::uint64_t quarantine(TrainingState& state) {
  Model& model = state.model;
  Moments& moments = state.moments;
  std::uint64_t count = cleared(model.logits, moments.first, moments.second) +
                        cleared(model.mlp, moments.mlp_first, moments.mlp_second) +
                        cleared(state.errors);
  for (std::size_t face = 0; face < model.faces(); ++face) {
    const auto corners = std::span(model.positions).subspan(3 * face, 3);
    const auto first = std::span(moments.vertex_first).subspan(3 * face, 3);
    const auto second = std::span(moments.vertex_second).subspan(3 * face, 3);
    const std::uint64_t bad_corners = cleared(floats(corners));
    const std::uint64_t bad = bad_corners + cleared(floats(first)) + cleared(second);
    if (bad_corners > 0) std::ranges::fill(corners, glm::vec3(0));
    if (bad > 0) {
      std::ranges::fill(first, glm::vec3(0));
      std::ranges::fill(second, 0.0f);
    }
    count += bad;
  }
  state.non_finite += count;
  return count;
}

}  // namespace tureen::trainer
