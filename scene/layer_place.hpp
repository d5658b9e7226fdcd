// A layer without its primitives.
#pragma once

#include <glm/mat4x4.hpp>
#include <optional>
#include <string>

#include "scene/material.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

struct LayerPlace {
  Bounds bounds = {};                // the box around its primitives, in layer coordinates
  glm::dmat4 world_from_layer{1.0};  // a similarity: defect() of a Layer accepts it
  bool visible = true;
  std::string name = {};
  std::optional<Material> material = {};  // as in Layer
};

}  // namespace tureen
