// Reads the files of a scene (viewer/scene/scene_source.hpp).
#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "base/input.hpp"
#include "base/steady_seconds.hpp"
#include "formats/scene_file.hpp"
#include "formats/scene_preview.hpp"
#include "scene/edit/moved_scene.hpp"
#include "scene/middle_bounds.hpp"
#include "viewer/names.hpp"
#include "viewer/scene/scene_source.hpp"

namespace tureen::viewer {

namespace {

namespace fs = std::filesystem;

/// Smaller files are read in less than about a third of a second; a preview would only delay them.
constexpr std::uint64_t min_previewed_bytes = 16 << 20;
/// Each preview has about four times as many splats as the one before, and at most a quarter of the
/// file. All previews together then take at most a third of the time for the whole file.
constexpr std::uint64_t preview_growth = 4, max_preview_fraction = 4;
/// A larger part would hardly change the image; the page has the same limit
/// (web/viewer/preview.ts).
constexpr std::uint64_t max_preview_bytes = 256 << 20;
/// Headers of files with previews are smaller.
constexpr std::uint64_t max_header_bytes = 1 << 20;

ReadOptions options_of(const ReadRequest& request, std::function<void(double)> progress) {
  return {.lod = request.lod, .max_splats = request.max_splats, .progress = std::move(progress)};
}

/// Appends the scene of a file, and its layers. They have no names yet.
void append_scene(SceneSource& source, const fs::path& path, const FileWatch& watch, Scene read,
                  std::optional<std::size_t> lod = {}) {
  auto scene = std::make_shared<Scene>(std::move(read));
  if (scene->info.name.empty()) scene->info.name = fs::path(short_name(path)).stem().string();
  // As merged() does, which the commands use.
  if (!source.files.empty()) turn_upright(*scene, source.files.front().header->info.up);
  for (std::size_t i = 0; i < scene->layers.size(); ++i) {
    Layer& layer = scene->layers[i];
    DocumentLayer& added = source.document.layers.emplace_back();
    added.id = source.document.new_id();
    added.bounds = framed_bounds(layer);
    added.world_from_layer = layer.world_from_layer;
    added.visible = layer.visible;
    added.material = layer.material;
    added.primitives =
        std::make_shared<const Primitives>(std::exchange(layer.primitives, TriangleSoup{}));
    source.origins[added.id] = {source.files.size(), i};
  }
  source.files.push_back({path, watch, std::move(scene), lod});
}

void append_file(SceneSource& source, const fs::path& path, const ReadOptions& options) {
  const FileWatch watch(path);
  append_scene(source, path, watch, read_scene(path, options), options.lod);
}

void append_files(SceneSource& source, const ReadRequest& request) {
  for (std::size_t i = 0; i < request.paths.size(); ++i) {
    request.begins(request.paths[i]);
    try {
      append_file(source, request.paths[i], options_of(request, [&](double done) {
                    request.progress((double(i) + done) / double(request.paths.size()));
                  }));
    } catch (const InputError& error) {
      const bool none_remains = source.files.empty() && i + 1 == request.paths.size();
      if (!request.unreadable || none_remains) throw;
      request.unreadable(request.paths[i], error.what());
    }
  }
}

/// Sets what the document has of the files.
void begin_document(SceneSource& source) {
  merge_files(source);
  source.up.axis = glm::dvec3(source.scene->info.up);
  update_subject(source);
  source.up = guess_up(evidence_of(*source.scene, source.subject));
  source.subject.up = source.up.axis;
  source.document.up = source.up.axis;
  source.document.quality = source.scene->quality;
}

/// Gives the layers of `file` the ids that they have in `before`.
void take_ids(SceneSource& source, std::size_t file, const SceneSource& before) {
  for (DocumentLayer& layer : source.document.layers) {
    const LayerOrigin origin = source.origins.at(layer.id);
    if (origin.file != file) continue;
    for (const auto& [id, old] : before.origins)
      if (old.file == file && old.index == origin.index &&
          before.files[file].header->layers[old.index].name == source.as_read(layer)->name) {
        source.origins.erase(layer.id);
        layer.id = id;
        source.origins[id] = origin;
        break;
      }
  }
}

}  // namespace

SceneSource read_source(const ReadRequest& request) {
  const double begin = steady_seconds();
  SceneSource source;
  append_files(source, request);
  begin_document(source);
  source.read_seconds = steady_seconds() - begin;
  return source;
}

SceneSource read_more(const SceneSource& before, const ReadRequest& request) {
  const double begin = steady_seconds();
  SceneSource source = before;
  append_files(source, request);
  merge_files(source);
  update_subject(source);
  source.read_seconds = steady_seconds() - begin;
  return source;
}

SceneSource read_again(const SceneSource& before, const ReadRequest& request) {
  const double begin = steady_seconds();
  SceneSource source;
  source.document.next_id = before.document.next_id;
  const std::vector<fs::path> drawn = before.paths();
  const double total = double(drawn.size() + request.paths.size());
  double finished = 0;
  for (std::size_t i = 0; i < before.files.size(); ++i) {
    const SceneFile& file = before.files[i];
    if (!has_layers(before, i)) {
      source.files.push_back(file);  // its cameras and settings may be those of the scene
      continue;
    }
    request.begins(file.path);
    ReadOptions options =
        options_of(request, [&](double done) { request.progress((finished + done) / total); });
    options.lod = request.level && request.level->first == i ? request.level->second : file.lod;
    append_file(source, file.path, options);
    take_ids(source, i, before);
    finished += 1;
  }
  ReadRequest further = request;
  further.progress = [&](double done) {
    request.progress((finished + done * double(request.paths.size())) / total);
  };
  append_files(source, further);
  begin_document(source);
  source.read_seconds = steady_seconds() - begin;
  return source;
}

std::optional<SourcePreview> read_source_preview(const fs::path& path, std::uint64_t shown,
                                                 const std::function<void()>& check) try {
  if (!fs::is_regular_file(path) || fs::file_size(path) < min_previewed_bytes) return {};
  const FileWatch watch(path);
  Input input = Input::open(path);
  std::vector<std::byte> prefix;
  const auto read_up_to = [&](std::uint64_t bytes) {
    const std::size_t before = prefix.size();
    check();
    prefix.resize(std::size_t(std::min(bytes, input.size())));
    input.read(std::span(prefix).subspan(before), "preview");
  };
  std::optional<PreviewSize> size;
  for (std::uint64_t bytes = 1 << 16; !size && bytes <= max_header_bytes; bytes *= 4) {
    read_up_to(bytes);
    // A preview has twice as many splats as the one that is named here as shown.
    size = preview_size(prefix, path.string(), preview_growth / 2 * shown);
  }
  if (!size || size->bytes == 0 ||
      size->bytes > std::min(input.size() / max_preview_fraction, max_preview_bytes))
    return {};
  read_up_to(std::max<std::uint64_t>(size->bytes, prefix.size()));
  check();
  std::optional<Scene> scene =
      read_preview(std::span(prefix).first(std::size_t(size->bytes)), path.string());
  if (!scene) return {};
  scene->info.notes.clear();
  scene->info.remarks.clear();
  SourcePreview preview{.source = {}, .bytes = size->bytes};
  append_scene(preview.source, path, watch, std::move(*scene));
  begin_document(preview.source);
  return preview;
} catch (const Error&) {
  return {};
} catch (const fs::filesystem_error&) {
  return {};
}

}  // namespace tureen::viewer
