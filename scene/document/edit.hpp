// Changes of a document, as values. Applying one returns the change that undoes it.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/document/document.hpp"

namespace tureen {

struct AddLayers {
  struct Added {
    std::size_t at = 0;  // its index afterwards; beyond the end: last
    DocumentLayer layer;
  };
  std::vector<Added> layers;  // not empty; in ascending order of their index
};
struct RemoveLayers {
  std::vector<LayerId> ids;  // not empty
};
struct PlaceLayer {
  LayerId id = 0;
  glm::dmat4 world_from_layer{1.0};
  std::optional<bool> visible = {};  // default: as before
};
struct RenameLayer {
  LayerId id = 0;
  std::string name;
};
struct ShowLayer {
  LayerId id = 0;
  bool visible = true;
};
struct SetMaterial {
  LayerId id = 0;  // of a soup
  std::optional<Material> material;
};
struct ReorderLayer {
  LayerId id = 0;
  std::size_t to = 0;  // its index afterwards; beyond the end: last
};
struct ChangeUp {
  glm::dvec3 up{0.0, 1.0, 0.0};
};
struct ChangeQuality {
  Quality quality;
};
struct ChangeProfile {
  std::optional<SplatProfile> profile;
};
struct ChangeBackground {
  std::optional<glm::vec3> background;
};
struct ChangeFirstView {
  std::optional<Camera> view;
};

using Edit = std::variant<AddLayers, RemoveLayers, PlaceLayer, RenameLayer, ShowLayer, SetMaterial,
                          ReorderLayer, ChangeUp, ChangeQuality, ChangeProfile, ChangeBackground,
                          ChangeFirstView>;

/// Changes the document. Returns the edit that undoes the change: applied to the result, it gives
/// the document before, except next_id. Ids that the document lacks are ignored, because a file
/// that is read again may have lost a layer.
Edit apply_edit(Document& document, const Edit& edit);

/// The name of the edit in a list of steps: "Move house". `document`: before or after the edit.
std::string describe(const Edit& edit, const Document& document);

/// Whether the second edit replaces the result of the first: both set the same thing.
bool sets_the_same(const Edit& first, const Edit& second);

/// Bytes of the primitives that the edit holds.
std::size_t byte_size(const Edit& edit);

}  // namespace tureen
