// Removes and orders the layers of a renderer as a list of them has them.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "runtime/renderer.hpp"

namespace tureen {

/// `layers` describes what the renderer has, in its order. Afterwards it is `wanted`: at least one
/// of them, in any order. `same`: whether two descriptions mean the same data. Uploads nothing.
template <class Layer, class Same>
void arrange_layers(Renderer& renderer, std::vector<Layer>& layers, std::vector<Layer> wanted,
                    const Same& same) {
  const auto find = [&](std::vector<Layer>& in, const Layer& layer) {
    return std::find_if(in.begin(), in.end(), [&](const Layer& each) { return same(each, layer); });
  };
  for (std::size_t i = layers.size(); i-- > 0;) {
    if (find(wanted, layers[i]) != wanted.end()) continue;
    renderer.remove_layer(i);
    layers.erase(layers.begin() + std::ptrdiff_t(i));
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto at = std::size_t(find(layers, wanted[i]) - layers.begin());
    if (at == i) continue;
    renderer.swap_layers(i, at);
    std::swap(layers[i], layers[at]);
  }
  layers = std::move(wanted);
}

}  // namespace tureen
