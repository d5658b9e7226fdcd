// The document of a PageView: its changes, its history, and the device that follows it.
#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "runtime/arrange_layers.hpp"
#include "web/engine/page_view.hpp"

namespace tureen::web {

namespace {

bool contains(const std::vector<LayerId>& layers, LayerId layer) {
  return std::find(layers.begin(), layers.end(), layer) != layers.end();
}

/// Whether two unit vectors are the same, but for rounding.
bool same_axis(const glm::dvec3& a, const glm::dvec3& b) { return glm::distance(a, b) < 1e-9; }

}  // namespace

const DocumentLayer& PageView::layer_with(LayerId id) const {
  if (const DocumentLayer* const layer = find_layer(document_, id)) return *layer;
  throw UsageError("there is no layer with the id " + std::to_string(id));
}

std::vector<LayerId> PageView::missing(const Document& document) const {
  std::vector<LayerId> result;
  for (const DocumentLayer& layer : document.layers)
    if (!contains(stage_->layers, layer.id)) result.push_back(layer.id);
  return result;
}

Similarity PageView::placement(const DocumentLayer& layer) const {
  const auto given = placements_.find(layer.id);
  const bool holds =
      given != placements_.end() && matrix_of(given->second) == layer.world_from_layer;
  return holds ? given->second : similarity_of(layer.world_from_layer);
}

// -- steps ----------------------------------------------------------------------------------------

void PageView::perform(const Edit& edit) {
  const Document before = document_;
  history_.perform(document_, edit, gesture_);
  follow(before);
}

std::vector<LayerId> PageView::go_to(std::size_t position) {
  if (!stage_) return {};
  Document document = document_;
  History history = history_;
  history.go_to(document, position);
  if (document.layers.empty())  // files were lost
    throw UsageError("this step cannot be undone: no layer would be left");
  if (std::vector<LayerId> lacking = missing(document); !lacking.empty()) return lacking;
  std::swap(document, document_);
  history_ = std::move(history);
  uploaded_.clear();
  follow(document);
  return {};
}

void PageView::place_layer(LayerId layer, const Similarity& placement,
                           std::optional<bool> visible) {
  place_layer(layer, matrix_of(placement), visible);
  placements_[layer] = placement;
}

void PageView::place_layer(LayerId layer, const glm::dmat4& world_from_layer,
                           std::optional<bool> visible) {
  const DocumentLayer& before = layer_with(layer);
  if (const auto reason = defect(Layer{.world_from_layer = world_from_layer}))
    throw UsageError("the layer cannot be placed: " + *reason);
  const bool shows = visible && *visible != before.visible;
  if (before.world_from_layer != world_from_layer) {
    // GCC 12 takes a member copied from an empty optional for uninitialised.
    perform(shows ? PlaceLayer{layer, world_from_layer, *visible}
                  : PlaceLayer{layer, world_from_layer, std::nullopt});
  } else if (shows) {
    perform(ShowLayer{layer, *visible});
  }
}

void PageView::show_layer(LayerId layer, bool visible) {
  if (layer_with(layer).visible != visible) perform(ShowLayer{layer, visible});
}

void PageView::move_layer(LayerId layer, std::size_t to) {
  layer_with(layer);
  if (to >= document_.layers.size())
    throw UsageError("there is no layer " + std::to_string(to) + ", counted from 0");
  if (document_.layers[to].id != layer) perform(ReorderLayer{layer, to});
}

void PageView::remove_layer(LayerId layer) {
  layer_with(layer);
  if (document_.layers.size() == 1)
    throw UsageError("the only layer cannot be removed: remove the scene");
  perform(RemoveLayers{{layer}});
}

void PageView::set_up(const glm::dvec3& axis) {
  controls().set_up(axis);
  follow_up_axis();
}

void PageView::home() {
  controls().reset();
  follow_up_axis();
}

void PageView::follow_up_axis() {
  if (stage_ && !preview_ && !same_axis(stage_->controls.up(), document_.up))
    perform(ChangeUp{stage_->controls.up()});
}

void PageView::set_background(glm::vec3 background) {
  if (!stage_ || preview_)
    paint(background);
  else if (document_.background != background)
    perform(ChangeBackground{background});
}

// -- the device -----------------------------------------------------------------------------------

DocumentLayer PageView::described(const PreparedScene& prepared, std::size_t layer, LayerId id) {
  const PreparedLayer& source = prepared.layers[layer];
  const LayerPlan& plan = *prepared.plan.layers[layer];
  const auto* splats = std::get_if<SplatPlan>(&plan);
  facts_[id] = {.triangles = splats ? 0 : std::get<SoupPlan>(plan).soup_faces,
                .splats = splats ? splats->splats : 0};
  DocumentLayer result;
  result.id = id;
  result.bounds = source.framed;
  result.world_from_layer = source.place.world_from_layer;
  result.visible = source.place.visible;
  return result;
}

void PageView::upload_layer(PreparedScene prepared, LayerId layer) {
  if (!stage_) throw UsageError("there is no scene for a further layer");
  Stage& stage = *stage_;
  if (stage.debug_views) throw UsageError("a debug view is shown: show the colours first");
  if (stage.layers.size() == max_layers)
    throw UsageError("at most " + std::to_string(max_layers) +
                     " layers can be drawn together: remove layers first");
  if (!stage.renderer) {  // the first one after the device was lost
    stage.renderer.emplace(context_, std::move(prepared));
    stage.renderer->sort_splats_with(make_sorter_());
    stage.renderer->set_background(glm::vec4(background_, 1.0f));
  } else {
    if (prepared.plan.reversed_depth != stage.renderer->plan().reversed_depth)
      throw UsageError("the layer was prepared for another device");
    stage.renderer->add_layers(std::move(prepared));
  }
  facts_[layer].device_bytes = stage.renderer->layer_bytes(stage.layers.size());
  stage.layers.push_back(layer);
}

void PageView::upload(PreparedScene prepared, const std::string& name) {
  DocumentLayer layer = described(prepared, 0, document_.new_id());
  layer.name = name;
  upload_layer(std::move(prepared), layer.id);
  uploaded_.push_back(layer);
  sync();
}

void PageView::upload_again(PreparedScene prepared, LayerId id) {
  const DocumentLayer layer = described(prepared, 0, id);
  upload_layer(std::move(prepared), id);
  history_.replace_primitives(layer);  // the file may have changed
  if (DocumentLayer* const known = find_layer(document_, id))
    known->bounds = layer.bounds;
  else
    uploaded_.push_back(layer);
  sync();
}

std::vector<LayerId> PageView::add_uploaded(bool is_step) {
  AddLayers edit;
  std::vector<LayerId> ids;
  for (const DocumentLayer& layer : std::exchange(uploaded_, {})) {
    edit.layers.push_back({document_.layers.size() + ids.size(), layer});
    ids.push_back(layer.id);
  }
  if (is_step) {
    perform(edit);
  } else {
    apply_edit(document_, edit);
    follow(document_);
  }
  return ids;
}

void PageView::drop_uploaded() {
  uploaded_.clear();
  if (stage_) sync();
}

void PageView::give_up(const std::vector<LayerId>& layers) {
  apply_edit(document_, RemoveLayers{layers});
  follow(document_);
}

/// Makes the device, the view and the background follow the document.
void PageView::follow(const Document& before) {
  sync();
  follow_layers();
  if (before.up != document_.up) stage_->controls.set_up(document_.up);
  if (before.background == document_.background) return;
  if (preview_)
    background_before_ = *document_.background;
  else
    paint(*document_.background);
}

/// Removes, orders, places and shows the layers on the device as the document has them.
void PageView::sync() {
  Stage& stage = *stage_;
  std::vector<LayerId> wanted;
  for (const DocumentLayer& layer : document_.layers)
    if (contains(stage.layers, layer.id)) wanted.push_back(layer.id);
  for (const DocumentLayer& layer : uploaded_) wanted.push_back(layer.id);
  if (!stage.renderer || wanted.empty()) return;  // a renderer has at least one layer
  const bool same_order = wanted == stage.layers;
  // The passes of debug views refer to the layers.
  if (!same_order && stage.debug_views) stage.renderer->set_passes({});
  arrange_layers(*stage.renderer, stage.layers, std::move(wanted), std::equal_to<>());
  for (std::size_t i = 0; i < stage.layers.size(); ++i) {
    const DocumentLayer* const layer = find_layer(document_, stage.layers[i]);
    if (layer) stage.renderer->place_layer(i, layer->world_from_layer);
    stage.renderer->show_layer(i, layer && layer->visible);
  }
  if (same_order || !stage.debug_views) return;
  stage.debug_views.emplace(read_layers());
  stage.debug_views->show(*stage.renderer, debug_view_, features_);
}

/// Gives the controls the box around the visible layers; around all if none is visible.
void PageView::follow_layers() {
  const auto& layers = document_.layers;
  const bool any = std::any_of(layers.begin(), layers.end(),
                               [](const DocumentLayer& layer) { return layer.visible; });
  std::vector<LayerPlace> boxes;
  for (const DocumentLayer& layer : layers)
    if (layer.visible || !any) boxes.push_back(layer);
  ShownScene& scene = stage_->scene;
  scene.subject = subject_of(boxes, scene.subject.up, scene.cameras);
  stage_->controls.set_subject(scene.subject);
}

}  // namespace tureen::web
