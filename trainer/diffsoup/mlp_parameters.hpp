// The color MLP as training holds it, a flat array of 595 numbers (MlpParameters), and as a scene
// holds it, a ColorMlp.
#pragma once

#include <cstdint>
#include <optional>

#include "scene/color_mlp.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

/// Random weights, biases 0: hidden layers Kaiming-uniform for ReLU, |w| < sqrt(6 / inputs); the
/// last one Xavier-uniform, |w| < sqrt(6 / (inputs + outputs)). As DiffSoup's code does; its paper
/// says Xavier for all.
MlpParameters initial_mlp(std::uint64_t seed);

ColorMlp color_mlp(const MlpParameters& parameters);

/// The parameters of a network shaped like ours (16-16-16-3, harmonics of degree 2, blend channel
/// 3), nothing for others. Where its directions run from the eye to the surface, the weights of the
/// odd harmonics change sign.
std::optional<MlpParameters> parameters_of(const ColorMlp& mlp);

}  // namespace tureen::trainer
