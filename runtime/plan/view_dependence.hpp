// How much of a color MLP's colour hangs on where it is looked at from.
#pragma once

#include "scene/color_mlp.hpp"

namespace tureen {

/// An upper bound of how far the predicted colour of any features can lie from what
/// without_direction(mlp) predicts, in any direction. The part of band l of a neuron's weights is
/// at most sqrt((2l+1) / 4 pi) |w_l| (Cauchy-Schwarz and the addition theorem), that of the bare
/// direction |w|; from layer to layer it grows by the absolute weights, and the sigmoid's slope is
/// at most 1/4. Not yet times the blend channel. 0 without a direction.
double view_dependence(const ColorMlp& mlp);

/// The network that sees the features alone, as if every direction were the middle of all.
ColorMlp without_direction(const ColorMlp& mlp);

}  // namespace tureen
