// A model and its light become a soup: texels, and the network that shows their glaze.
#pragma once

#include <functional>
#include <string>

#include "soup/scene.hpp"
#include "surface.hpp"

namespace tureen::example {

struct BakeOptions {
  /// Called with what is being done and the fraction of it, 0..1.
  std::function<void(const std::string& what, double fraction)> progress;
};

/// Features 0..2 are the diffuse colour, 3 the gloss, 4..6 the normal as (n + 1) / 2, quantised to
/// 8 bits; then the network is trained on these very texels.
TriangleSoup bake(const Model& model, const BakeOptions& options = {});

/// The scene around the soup: cameras, background, name.
Scene staged(TriangleSoup soup);

}  // namespace tureen::example
