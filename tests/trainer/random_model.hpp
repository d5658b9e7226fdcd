// Random models, for tests that transform models.
#pragma once

#include <cmath>
#include <vector>

#include "scene/lattice.hpp"
#include "tests/support/random.hpp"
#include "trainer/diffsoup/mlp_parameters.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer::test {

using tureen::test::Random;

struct ModelOptions {
  std::size_t faces = 20;
  int min_level = 0;
  int max_level = 2;
  double logit_deviation = 2.0;  // of every level
};

inline Model random_model(std::uint64_t seed, const ModelOptions& options) {
  Random random(seed);
  Model model{.min_level = options.min_level,
              .max_level = options.max_level,
              .positions = {},
              .logits = {},
              .mlp = initial_mlp(seed),
              .origin = {10.0, -20.0, 30.0}};
  for (std::size_t i = 0; i < 3 * options.faces; ++i)
    model.positions.emplace_back(random.normal(), random.normal(), random.normal());
  model.logits.resize(model.faces() * model.texels() * channels);
  for (float& logit : model.logits) logit = float(options.logit_deviation * random.normal());
  return model;
}

/// The fine texture of a face at barycentrics (b0, b1), as a pixel there fetches it.
inline double textured(const std::vector<float>& fine, int level, double b0, double b1,
                       int channel) {
  const auto at = lattice::footprint(level, b0, b1);
  double value = 0;
  for (int k = 0; k < 3; ++k)
    value += at.weights[k] * double(fine[std::size_t(at.texels[k]) * channels + channel]);
  return value;
}

/// The sum of all levels of a face at barycentrics (b0, b1), in double, with each level
/// interpolated separately.
inline double summed_logit(const Model& model, std::size_t face, double b0, double b1,
                           int channel) {
  std::span<const float> logits = model.face_logits(face);
  double sum = 0;
  for (int level = model.min_level; level <= model.max_level; ++level) {
    const auto at = lattice::footprint(level, b0, b1);
    for (int k = 0; k < 3; ++k)
      sum += at.weights[k] * double(logits[std::size_t(at.texels[k]) * channels + channel]);
    logits = logits.subspan(std::size_t(lattice::texel_count(level)) * channels);
  }
  return sum;
}

}  // namespace tureen::trainer::test
