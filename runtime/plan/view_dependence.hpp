// Bounds the view dependence of a color MLP's colour.
#pragma once

#include "scene/color_mlp.hpp"

namespace tureen {

/// Upper bound, over all features and directions, of the difference between the predicted colour
/// and the prediction of without_direction(mlp). Band l of a neuron's weights contributes at most
/// sqrt((2l+1) / 4 pi) |w_l| (Cauchy-Schwarz and the addition theorem), the bare direction |w|.
/// Each layer multiplies the bound by its absolute weights, and the sigmoid's slope is at most 1/4.
/// The blend channel is not included. 0 without a direction.
double view_dependence(const ColorMlp& mlp);

/// The network of the features alone, with the mean over all directions as its direction.
ColorMlp without_direction(const ColorMlp& mlp);

}  // namespace tureen
