#include "viewer/scene/scene_source.hpp"

#include <algorithm>
#include <utility>

#include "camera/capture.hpp"
#include "formats/sog/sog_remarks.hpp"
#include "scene/middle_bounds.hpp"
#include "viewer/names.hpp"

namespace tureen::viewer {

namespace fs = std::filesystem;

namespace {

/// The files' headers, without removed layers and without files that have no others. The first file
/// stays, because cameras and settings are its own.
std::vector<Scene> headers_of(const SceneSource& source) {
  std::vector<Scene> headers;
  for (std::size_t file = 0; file < source.files.size(); ++file) {
    if (file > 0 && !has_layers(source, file)) continue;
    Scene header = *source.files[file].header;
    std::vector<Layer> layers;
    for (std::size_t i = 0; i < header.layers.size(); ++i)
      if (has_layers(source, file, i)) layers.push_back(std::move(header.layers[i]));
    header.layers = std::move(layers);
    headers.push_back(std::move(header));
  }
  return headers;
}

/// The panel's control that changes the assumption; "" if there is none.
std::string control_of(const Remark& remark) {
  const std::string_view setting = remark.kind->setting;
  return setting == "up"        ? "; Up in the panel View changes it"
         : setting == "profile" ? "; Profile in the panel Drawing changes it"
         : setting == "lod"     ? "; Level in the panel Scene changes it"
                                : "";
}

}  // namespace

bool has_layers(const SceneSource& source, std::size_t file, std::optional<std::size_t> index) {
  return std::any_of(source.document.layers.begin(), source.document.layers.end(),
                     [&](const DocumentLayer& layer) {
                       const auto origin = source.origins.find(layer.id);
                       return origin != source.origins.end() && origin->second.file == file &&
                              (!index || origin->second.index == *index);
                     });
}

std::size_t primitive_count(const DocumentLayer& layer) {
  const TriangleSoup* const soup = soup_of(layer);
  return soup ? soup->triangles.size() : count(*splats_of(layer));
}

std::vector<fs::path> SceneSource::paths() const {
  std::vector<fs::path> result;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (has_layers(*this, i)) result.push_back(files[i].path);
  if (result.empty()) result.push_back(path());
  return result;
}

const Layer* SceneSource::as_read(const DocumentLayer& layer) const {
  const auto origin = origins.find(layer.id);
  if (origin == origins.end()) return nullptr;
  return &files[origin->second.file].header->layers[origin->second.index];
}

bool SceneSource::is_as_read() const {
  std::size_t at = 0;
  for (std::size_t file = 0; file < files.size(); ++file) {
    if (file > 0 && !has_layers(*this, file)) continue;
    for (std::size_t i = 0; i < files[file].header->layers.size(); ++i, ++at) {
      if (at == document.layers.size()) return false;
      const DocumentLayer& layer = document.layers[at];
      const auto origin = origins.find(layer.id);
      if (origin == origins.end() || origin->second.file != file || origin->second.index != i ||
          layer.name != origin->second.name)
        return false;
      const Layer& read = *as_read(layer);
      if (layer.world_from_layer != read.world_from_layer || layer.visible != read.visible ||
          layer.material != read.material)
        return false;
    }
  }
  return at == document.layers.size();
}

bool SceneSource::is_from_files() const {
  return std::all_of(document.layers.begin(), document.layers.end(),
                     [&](const DocumentLayer& layer) { return origins.contains(layer.id); });
}

bool names_levels(const Remark& remark) {
  return remark.kind == &remarks::level_chosen || remark.kind == &remarks::level_read;
}

std::optional<DetailLevels> levels_of(const SceneFile& file) {
  for (const Remark& remark : file.header->info.remarks) {
    if (!names_levels(remark)) continue;
    const auto number = [&](std::size_t field) {
      return std::size_t(std::get<std::uint64_t>(remark.fields[field].value));
    };
    return DetailLevels{number(0), number(1)};
  }
  return std::nullopt;
}

std::optional<std::size_t> lod_of(const SceneSource& source) {
  for (const SceneFile& file : source.files)
    if (file.lod && levels_of(file)) return file.lod;
  return std::nullopt;
}

bool has_splats(const SceneSource& source) {
  const auto& layers = source.document.layers;
  return std::any_of(layers.begin(), layers.end(), [](const DocumentLayer& layer) {
    return layer.primitives && splats_of(layer);
  });
}

glm::vec3 background_of(const SceneSource& source) {
  return source.document.background.value_or(source.scene->info.background);
}

std::optional<Camera> first_view_of(const SceneSource& source) {
  if (source.document.first_view) return source.document.first_view;
  return first_view_of(source.scene->first_view, source.scene->cameras, source.up.axis);
}

std::vector<std::string> window_notes(const SceneInfo& info) {
  std::vector<std::string> notes = info.notes;
  for (const Remark& remark : info.remarks) notes.push_back(describe(remark) + control_of(remark));
  return notes;
}

std::vector<std::string> named_notes(const SceneSource& source) {
  std::vector<Scene> headers = headers_of(source);
  headers.emplace_back();  // merged() returns a single scene without names
  return window_notes(merged(std::move(headers)).info);
}

std::vector<PlacedLayer> placed_layers(const std::vector<DocumentLayer>& layers) {
  std::vector<PlacedLayer> result;
  for (const DocumentLayer& layer : layers)
    result.push_back(placed_layer(*layer.primitives, layer));
  return result;
}

std::vector<DocumentLayer> layers_for_rays(const SceneSource& source,
                                           std::map<LayerId, ProfiledSplats>& known) {
  const Document& document = source.document;
  std::erase_if(known, [&](const auto& each) { return !find_layer(document, each.first); });
  std::vector<DocumentLayer> layers = document.layers;
  for (DocumentLayer& layer : layers) {
    const Splats* const splats = splats_of(layer);
    if (!splats || splats->profile == document.profile.value_or(splats->profile)) continue;
    ProfiledSplats& own = known[layer.id];
    if (own.stored != layer.primitives ||
        std::get<Splats>(*own.drawn).profile != *document.profile) {
      Splats drawn = *splats;
      drawn.profile = *document.profile;
      own = {layer.primitives, std::make_shared<const Primitives>(std::move(drawn))};
    }
    layer.primitives = own.drawn;
  }
  return layers;
}

Subjects subjects_of(const SceneSource& source) {
  const auto& layers = source.document.layers;
  return std::any_of(layers.begin(), layers.end(), soup_of) ? Subjects::triangles
                                                            : Subjects::splats;
}

std::optional<std::string> why_not(DebugView what, const SceneSource& source) {
  if (what == DebugView::color) return std::nullopt;
  const std::vector<DocumentLayer>& layers = source.document.layers;
  for (const DocumentLayer& layer : layers)
    if (const auto reason = tureen::why_not(what, *layer.primitives))
      return layers.size() > 1 ? layer.name + ": " + *reason : *reason;
  return std::nullopt;
}

int feature_count(const SceneSource& source) {
  int fewest = LatticeTexture::features;
  for (const DocumentLayer& layer : source.document.layers)
    fewest = std::min(fewest, soup_of(layer) ? tureen::feature_count(*soup_of(layer)) : 0);
  return fewest;
}

AddLayers add_files(SceneSource& source, const SceneSource& more, const SceneSource& known) {
  const std::size_t present = source.files.size(), before = known.files.size();
  source.files.insert(source.files.end(), more.files.begin() + std::ptrdiff_t(before),
                      more.files.end());
  AddLayers edit;
  for (const DocumentLayer& layer : more.document.layers) {
    if (layer.id < known.document.next_id) continue;
    LayerOrigin origin = more.origins.at(layer.id);
    origin.file += present - before;
    source.origins[layer.id] = origin;
    edit.layers.push_back({source.document.layers.size() + edit.layers.size(), layer});
  }
  source.read_seconds = more.read_seconds;
  return edit;
}

void keep_changes(SceneSource& read, const SceneSource& now) {
  Document document = now.document;
  std::vector<DocumentLayer> layers;
  for (const DocumentLayer& old : now.document.layers) {
    const auto origin = now.origins.find(old.id);
    const DocumentLayer* const same = find_layer(read.document, old.id);
    if (same) {
      const Layer& before = *now.as_read(old);
      DocumentLayer& layer = layers.emplace_back(*same);
      layer.name = old.name;
      if (old.world_from_layer != before.world_from_layer)
        layer.world_from_layer = old.world_from_layer;
      if (old.visible != before.visible) layer.visible = old.visible;
      if (old.material != before.material) layer.material = old.material;
      read.origins[old.id].name = origin->second.name;
    } else if (origin == now.origins.end() ||
               read.files[origin->second.file].header == now.files[origin->second.file].header) {
      layers.push_back(old);  // it exists only in memory, or its file was not read again
    }
  }
  for (const DocumentLayer& layer : read.document.layers)
    if (!now.origins.contains(layer.id)) layers.push_back(layer);
  // A changed file may have lost all layers that were not removed.
  document.layers = layers.empty() ? read.document.layers : std::move(layers);
  document.next_id = std::max(document.next_id, read.document.next_id);
  if (document.quality == now.scene->quality) document.quality = read.scene->quality;
  for (const auto& [id, origin] : now.origins) read.origins.insert({id, origin});
  read.document = std::move(document);
  merge_files(read);
  update_subject(read);
}

void merge_files(SceneSource& source) {
  source.scene = std::make_shared<const Scene>(merged(headers_of(source)));
  std::map<std::pair<std::size_t, std::size_t>, DocumentLayer*> in_order;
  for (DocumentLayer& layer : source.document.layers)
    if (const auto origin = source.origins.find(layer.id); origin != source.origins.end())
      in_order[{origin->second.file, origin->second.index}] = &layer;
  std::size_t at = 0;
  for (const auto& [place, layer] : in_order) {
    const std::string& name = source.scene->layers[at++].name;
    if (!layer->name.empty()) continue;
    layer->name = name.empty() ? source.files[place.first].header->info.name : name;
    source.origins[layer->id].name = layer->name;
  }
}

void update_subject(SceneSource& source) {
  const std::vector<LayerPlace> places(source.document.layers.begin(),
                                       source.document.layers.end());
  source.subject = subject_of(places, source.up.axis, source.files.front().header->cameras);
}

}  // namespace tureen::viewer
