// What a program shows and its user changes: layers with ids, and the settings that a scene stores.
// It changes by edits (scene/document/edit.hpp), which can be undone.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "scene/layer_place.hpp"
#include "scene/quality.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Identifies a layer for the lifetime of its document. No id is used twice.
using LayerId = std::uint64_t;

/// The primitives never change, so that background jobs can share them. Only edits change the rest.
struct DocumentLayer : LayerPlace {
  LayerId id = 0;
  std::shared_ptr<const Primitives> primitives = {};  // null in programs that keep ids alone
};

struct Document {
  std::vector<DocumentLayer> layers;         // at equal depth the earlier layer wins
  glm::dvec3 up{0.0, 1.0, 0.0};              // unit length
  Quality quality = {};                      // without a defect()
  std::optional<SplatProfile> profile = {};  // of all splats; default: their own
  std::optional<glm::vec3> background = {};  // display-referred; default: that of the first file
  std::optional<Camera> first_view = {};     // Scene::first_view; default: that of the first file
  LayerId next_id = 1;                       // larger than all ids

  LayerId new_id() { return next_id++; }
};

/// The layer with this id, or null.
inline DocumentLayer* find_layer(Document& document, LayerId id) {
  for (DocumentLayer& layer : document.layers)
    if (layer.id == id) return &layer;
  return nullptr;
}
inline const DocumentLayer* find_layer(const Document& document, LayerId id) {
  return find_layer(const_cast<Document&>(document), id);
}

}  // namespace tureen
