#include "scene/document/edit.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "scene/similarity.hpp"

namespace tureen {

namespace {

/// Sets a member of a layer. Returns its value before, or `value` if the document lacks the layer.
template <class T>
T set_member(Document& document, LayerId id, T LayerPlace::*member, const T& value) {
  DocumentLayer* const layer = find_layer(document, id);
  return layer ? std::exchange(layer->*member, value) : value;
}

std::ptrdiff_t index_of(const Document& document, LayerId id) {
  const auto& layers = document.layers;
  return std::find_if(layers.begin(), layers.end(),
                      [&](const DocumentLayer& layer) { return layer.id == id; }) -
         layers.begin();
}

struct Apply {
  Document& document;

  Edit operator()(const AddLayers& edit) const {
    RemoveLayers undo;
    for (const AddLayers::Added& each : edit.layers) {
      const auto at = std::ptrdiff_t(std::min(each.at, document.layers.size()));
      document.layers.insert(document.layers.begin() + at, each.layer);
      document.next_id = std::max(document.next_id, each.layer.id + 1);
      undo.ids.push_back(each.layer.id);
    }
    return undo;
  }
  Edit operator()(const RemoveLayers& edit) const {
    AddLayers undo;
    std::vector<DocumentLayer> kept;
    for (std::size_t i = 0; i < document.layers.size(); ++i) {
      const DocumentLayer& layer = document.layers[i];
      if (std::find(edit.ids.begin(), edit.ids.end(), layer.id) == edit.ids.end())
        kept.push_back(layer);
      else
        undo.layers.push_back({i, layer});
    }
    document.layers = std::move(kept);
    return undo;
  }
  Edit operator()(const PlaceLayer& edit) const {
    PlaceLayer undo{edit.id, set_member(document, edit.id, &LayerPlace::world_from_layer,
                                        edit.world_from_layer)};
    if (edit.visible)
      undo.visible = set_member(document, edit.id, &LayerPlace::visible, *edit.visible);
    return undo;
  }
  Edit operator()(const RenameLayer& edit) const {
    return RenameLayer{edit.id, set_member(document, edit.id, &LayerPlace::name, edit.name)};
  }
  Edit operator()(const ShowLayer& edit) const {
    return ShowLayer{edit.id, set_member(document, edit.id, &LayerPlace::visible, edit.visible)};
  }
  Edit operator()(const SetMaterial& edit) const {
    return SetMaterial{edit.id,
                       set_member(document, edit.id, &LayerPlace::material, edit.material)};
  }
  Edit operator()(const ReorderLayer& edit) const {
    auto& layers = document.layers;
    const std::ptrdiff_t from = index_of(document, edit.id);
    if (std::size_t(from) == layers.size()) return edit;
    const auto to = std::ptrdiff_t(std::min(edit.to, layers.size() - 1));
    const auto first = layers.begin() + std::min(from, to);
    const auto end = layers.begin() + std::max(from, to) + 1;
    std::rotate(first, from < to ? first + 1 : end - 1, end);
    return ReorderLayer{edit.id, std::size_t(from)};
  }
  Edit operator()(const ChangeUp& edit) const {
    return ChangeUp{std::exchange(document.up, edit.up)};
  }
  Edit operator()(const ChangeQuality& edit) const {
    return ChangeQuality{std::exchange(document.quality, edit.quality)};
  }
  Edit operator()(const ChangeProfile& edit) const {
    return ChangeProfile{std::exchange(document.profile, edit.profile)};
  }
  Edit operator()(const ChangeBackground& edit) const {
    return ChangeBackground{std::exchange(document.background, edit.background)};
  }
  Edit operator()(const ChangeFirstView& edit) const {
    return ChangeFirstView{std::exchange(document.first_view, edit.view)};
  }
};

struct Describe {
  const Document& document;

  std::string name_of(LayerId id) const {
    const DocumentLayer* const layer = find_layer(document, id);
    return layer ? layer->name : "a layer";
  }
  static std::string one_or(const std::string& name, std::size_t count) {
    return count == 1 ? name : std::to_string(count) + " layers";
  }
  std::string operator()(const AddLayers& edit) const {
    return "Add " + one_or(edit.layers.front().layer.name, edit.layers.size());
  }
  std::string operator()(const RemoveLayers& edit) const {
    return "Remove " + one_or(name_of(edit.ids.front()), edit.ids.size());
  }
  std::string operator()(const PlaceLayer& edit) const {
    const DocumentLayer* const layer = find_layer(document, edit.id);
    if (!layer) return "Place " + name_of(edit.id);
    const Similarity before = similarity_of(layer->world_from_layer);
    const Similarity after = similarity_of(edit.world_from_layer);
    // Angles and scales come from matrices, which round them.
    constexpr double rounding = 1e-6;
    const bool moves = before.position != after.position, mirrors = before.mirror != after.mirror;
    const bool turns = glm::distance(before.angles, after.angles) > rounding;
    const bool scales = std::abs(after.scale / before.scale - 1) > rounding;
    const bool shows = edit.visible.value_or(layer->visible) != layer->visible;
    const char* const word = moves + turns + scales + mirrors + shows > 1 ? "Place "
                             : turns                                      ? "Turn "
                             : scales                                     ? "Scale "
                             : mirrors                                    ? "Mirror "
                                                                          : "Move ";
    return word + layer->name;
  }
  std::string operator()(const RenameLayer& edit) const { return "Rename " + name_of(edit.id); }
  std::string operator()(const ShowLayer& edit) const {
    return (edit.visible ? "Show " : "Hide ") + name_of(edit.id);
  }
  std::string operator()(const SetMaterial& edit) const {
    return "Change the surface of " + name_of(edit.id);
  }
  std::string operator()(const ReorderLayer& edit) const { return "Reorder " + name_of(edit.id); }
  std::string operator()(const ChangeUp&) const { return "Change the up axis"; }
  std::string operator()(const ChangeQuality&) const { return "Change the quality"; }
  std::string operator()(const ChangeProfile&) const { return "Change the profile"; }
  std::string operator()(const ChangeBackground&) const { return "Change the background"; }
  std::string operator()(const ChangeFirstView&) const { return "Change the first view"; }
};

}  // namespace

Edit apply_edit(Document& document, const Edit& edit) { return std::visit(Apply{document}, edit); }

std::string describe(const Edit& edit, const Document& document) {
  return std::visit(Describe{document}, edit);
}

bool sets_the_same(const Edit& first, const Edit& second) {
  if (first.index() != second.index()) return false;
  if (const auto* place = std::get_if<PlaceLayer>(&first)) {
    const auto& next = std::get<PlaceLayer>(second);
    // What undoes the first must also undo a change of the visibility.
    return place->id == next.id && (place->visible || !next.visible);
  }
  if (const auto* name = std::get_if<RenameLayer>(&first))
    return name->id == std::get<RenameLayer>(second).id;
  if (const auto* surface = std::get_if<SetMaterial>(&first))
    return surface->id == std::get<SetMaterial>(second).id;
  return std::holds_alternative<ChangeUp>(first) || std::holds_alternative<ChangeQuality>(first) ||
         std::holds_alternative<ChangeBackground>(first);
}

std::size_t byte_size(const Edit& edit) {
  std::size_t bytes = 0;
  if (const auto* added = std::get_if<AddLayers>(&edit))
    for (const AddLayers::Added& each : added->layers)
      if (each.layer.primitives)
        bytes +=
            std::visit([](const auto& kind) { return byte_size(kind); }, *each.layer.primitives);
  return bytes;
}

}  // namespace tureen
