// Conversions between the color MLP in training, a flat array of 595 numbers (MlpParameters), and
// in a scene, a ColorMlp.
#pragma once

#include <cstdint>
#include <optional>

#include "scene/color_mlp.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

/// Random weights, biases 0. Hidden layers are Kaiming-uniform for ReLU, |w| < sqrt(6 / inputs);
/// the last layer is Xavier-uniform, |w| < sqrt(6 / (inputs + outputs)). This follows DiffSoup's
/// code; its paper has Xavier for all layers.
MlpParameters initial_mlp(std::uint64_t seed);

ColorMlp color_mlp(const MlpParameters& parameters);

/// The parameters of a network with our shape (16-16-16-3, harmonics of degree 2, blend channel 3);
/// nothing for other shapes. If the network's directions point from the eye to the surface, the
/// weights of the odd harmonics change sign.
std::optional<MlpParameters> parameters_of(const ColorMlp& mlp);

}  // namespace tureen::trainer
