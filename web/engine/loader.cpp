// Commands that read a scene and prepare it for the device of another instance.
#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "camera/capture.hpp"
#include "camera/up_axis.hpp"
#include "formats/scene_file.hpp"
#include "formats/scene_preview.hpp"
#include "runtime/debug_views/debug_view.hpp"
#include "runtime/device_forecast.hpp"
#include "runtime/render_options.hpp"
#include "scene/edit/edits.hpp"
#include "scene/edit/moved_scene.hpp"
#include "web/engine/engine.hpp"
#include "web/engine/page_options.hpp"
#include "web/engine/prepared_archive.hpp"
#include "web/engine/scene_path.hpp"

namespace tureen::web {

namespace {

/// The reason of the first layer without this debug view, or nullopt.
std::optional<std::string> why_not_all(DebugView what, const Scene& scene) {
  if (what == DebugView::color) return {};
  for (const Layer& layer : scene.layers)
    if (auto reason = why_not(what, layer.primitives)) return reason;
  return {};
}

Json debug_views_of(const Scene& scene) {
  const Subjects subjects = triangle_count(scene) == 0 ? Subjects::splats : Subjects::triangles;
  Json list = Json::array();
  for (const DebugViewName& name : debug_view_names()) {
    const auto reason = why_not_all(name.what, scene);
    list.push_back(object({{"name", name.name},
                           {"title", name.title},
                           {"meaning", meaning_of(name, subjects)},
                           {"missing", reason ? Json(*reason) : Json()}}));
  }
  return list;
}

/// The remarks without the program's options: a page has no options.
Json notes_of(const Scene& scene) {
  Json notes = scene.info.notes;
  for (const Remark& remark : scene.info.remarks) notes.push_back(describe(remark));
  return notes;
}

std::string described_kernel(const Splats& splats) {
  return kernel_name(splats.kernel) + (" (profile " + std::string(profile_name(splats)) + ")");
}

/// The appearances and kernels of all layers, each once: "lattice texture, Gaussians (profile
/// 3dgs)".
std::string appearances_of(std::span<const PlacedLayer> layers) {
  std::vector<std::string> known;
  std::string names;
  for (const PlacedLayer& layer : layers) {
    const std::string name =
        layer.soup ? appearance_name(layer.soup->appearance) : described_kernel(*layer.splats);
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    known.push_back(name);
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

Json describe(const Scene& scene) {
  const std::vector<PlacedLayer> layers = placed_layers(scene);
  Json names = Json::array(), cameras = Json::array();
  std::size_t triangles = 0, splats = 0;
  int features = layers.empty() ? 0 : std::numeric_limits<int>::max();
  for (const PlacedLayer& layer : layers) {
    if (layer.soup)
      triangles += layer.soup->triangles.size();
    else
      splats += count(*layer.splats);
    features = std::min(features, layer.soup ? feature_count(*layer.soup) : 0);
    names.push_back(layer.place.name);
  }
  Subject subject = tureen::subject_of(scene);
  const UpGuess up = guess_up(evidence_of(scene, subject));
  subject.up = up.axis;
  for (const Camera& camera : scene.cameras) cameras.push_back(to_json(camera));
  const auto first = first_view_of(scene.first_view, scene.cameras, up.axis);
  return object({{"name", scene.info.name},
                 {"source", scene.info.source},
                 {"notes", notes_of(scene)},
                 {"layer_names", names},
                 {"triangles", triangles},
                 {"splats", splats},
                 {"appearance", appearances_of(layers)},
                 {"cameras", cameras},
                 {"first_view", first ? to_json(*first) : Json()},
                 {"background", to_json(glm::dvec3(scene.info.background))},
                 {"subject", to_json(subject)},
                 {"file_up", to_json(glm::dvec3(scene.info.up))},
                 {"up_reason", describe(up)},
                 {"debug_views", debug_views_of(scene)},
                 {"feature_count", features}});
}

/// Frees the scene and the buffer: a scene that is read next needs the memory.
void forget(Engine& engine) {
  engine.loader = {};
  std::vector<std::byte>().swap(engine.buffer);
}

Json take(Engine& engine, Scene scene) {
  forget(engine);
  engine.loader.scene = std::move(scene);
  return describe(*engine.loader.scene);
}

/// Ends read_scene() before the memory for the splats is taken.
struct TooManySplats {
  std::uint64_t splats, bytes;
};

/// {"folder", "paths", "memory" or "max_splats", "lod"?, "up"?, "elsewhere"}: reads any scene from
/// the file system of this instance, and turns it upright if `up` is another axis. Returns its
/// description; {"offer": {"splats", "bytes", "fitting"}} if its splats need more than `memory`;
/// null if another program may read it (`elsewhere`) and this one does not.
Json read(Engine& engine, const Json& arguments) {
  forget(engine);  // a preview
  const bool elsewhere = arguments.at("elsewhere").get<bool>();
  if (elsewhere && !is_scene(scene_path(arguments))) return nullptr;
  ReadOptions options = read_options(arguments);
  options.progress = report_progress;
  EarlyTexels early = std::exchange(engine.early_texels, {});
  options.early_texels = &early;
  if (!options.max_splats)
    options.found_splats = [memory = arguments.at("memory").get<double>()](std::uint64_t splats,
                                                                           std::uint64_t bytes) {
      if (load_bytes(double(splats), double(bytes)) > memory) throw TooManySplats{splats, bytes};
    };
  try {
    Scene scene = read_scene(scene_path(arguments), options);
    if (const auto up = arguments.find("up"); up != arguments.end())
      turn_upright(scene, glm::vec3(vector_of(*up)));
    return take(engine, std::move(scene));
  } catch (const ReadElsewhere&) {
    if (!elsewhere) throw;
    return nullptr;
  } catch (const TooManySplats& many) {
    const double bytes = load_bytes(double(many.splats), double(many.bytes));
    const double fitting = arguments.at("memory").get<double>() / bytes * double(many.splats);
    return object(
        {{"offer", object({{"splats", many.splats},
                           {"bytes", bytes},
                           {"fitting", std::max<std::uint64_t>(1, std::uint64_t(fitting))}})}});
  }
}

/// {"name", "shown": number of bytes of the last preview}; the buffer holds the first bytes of a
/// file. Returns {"size": number of bytes for a preview, 0 if there is no further one,
/// "has_splats"}; null if more bytes are needed to decide.
Json preview_size(Engine& engine, const Json& arguments) {
  const auto next = tureen::preview_size(engine.buffer, arguments.at("name").get<std::string>(),
                                         arguments.at("shown").get<std::uint64_t>());
  if (!next) return nullptr;
  return object({{"size", next->bytes}, {"has_splats", next->has_splats}});
}

/// {"name"}; the buffer holds at least the number of bytes from "preview_size".
Json preview(Engine& engine, const Json& arguments) {
  engine.loader = {};  // the preview before
  auto scene = read_preview(engine.buffer, arguments.at("name").get<std::string>());
  return scene ? take(engine, std::move(*scene)) : Json();
}

/// The scene's layers, with lattices of at most this level.
void place_layers(Loader& loader, std::optional<int> level) {
  const Scene& scene = loader.scene.value();
  loader.reduced.clear();
  loader.placed = placed_layers(scene);
  for (PlacedLayer& layer : loader.placed)
    if (level && layer.soup && std::holds_alternative<LatticeTexture>(layer.soup->appearance))
      layer.soup = &loader.reduced.emplace_back(
          edited(*layer.soup, {.lattice_level = *level}, report_progress));
}

/// {"limits": result of "start", "level"?: maximum lattice level, "layer"?: only this layer}.
/// Writes the head to the buffer and returns the blobs.
Json prepare(Engine& engine, const Json& arguments) {
  Loader& loader = engine.loader;
  loader.prepared.reset();
  const auto level = arguments.find("level"), layer = arguments.find("layer");
  place_layers(loader, level == arguments.end() ? std::nullopt : std::optional(level->get<int>()));
  std::span<const PlacedLayer> chosen = loader.placed;
  if (layer != arguments.end()) chosen = chosen.subspan(layer->get<std::size_t>(), 1);
  const Json& limits = arguments.at("limits");
  loader.prepared = prepare_scene(chosen, limits_of(limits),
                                  page_options(*loader.scene, blending_of(limits.at("blend"))));
  engine.buffer = pack_head(*loader.prepared);
  Json blobs = Json::array();
  for (std::size_t i = 0; i < blob_count(*loader.prepared); ++i)
    blobs.push_back(object({{"size", blob_size(*loader.prepared, i)},
                            {"grain", blob_grain(*loader.prepared, i)},
                            {"is_store", store_of(*loader.prepared, i).source != nullptr}}));
  return blobs;
}

/// {"limits"}: the bytes that each layer will need on that device. Layers are planned alone,
/// because they are uploaded one after the other.
Json forecast(Engine& engine, const Json& arguments) {
  const Scene& scene = engine.loader.scene.value();
  const DeviceLimits limits = limits_of(arguments.at("limits"));
  const PlanPreferences preferences =
      page_options(scene, blending_of(arguments.at("limits").at("blend"))).plan;
  Json layers = Json::array();
  for (const PlacedLayer& layer : placed_layers(scene)) {
    const RenderPlan plan = make_plan(std::span(&layer, 1), limits, preferences);
    layers.push_back(layer.soup             ? device_forecast(*layer.soup, plan.soup(0)).bytes
                     : plan.splats_in_tiles ? 0
                                            : device_forecast(*layer.splats, plan.splats(0)).bytes);
  }
  return layers;
}

/// {"blob", "offset", "size"}: writes the bytes to the buffer.
void read_block(Engine& engine, const Json& arguments) {
  engine.buffer.resize(arguments.at("size").get<std::size_t>());
  read_blob(engine.loader.prepared.value(), arguments.at("blob"), arguments.at("offset"),
            engine.buffer);
}

Json range_json(const FileRange& range) {
  return object({{"offset", range.offset}, {"size", range.size}});
}

/// The buffer holds the first bytes of a file. Returns the places of the strips of texels that can
/// be decoded before the whole file is there.
Json begin_texels(Engine& engine, const Json&) {
  // The header alone decides about this memory. Larger scenes are read as without early texels.
  constexpr std::uint64_t max_bytes = 512 << 20;
  engine.early_texels = {};
  // The caller ignores errors: "read" reports them again.
  std::vector<TexelStrip> strips = texel_strips(engine.buffer, std::string());
  std::uint64_t bytes = 0;
  Json list = Json::array();
  for (const TexelStrip& strip : strips) {
    bytes += strip.texel_bytes();
    list.push_back(range_json(strip.range()));
  }
  if (bytes > max_bytes) return Json::array();
  engine.early_texels = EarlyTexels(std::move(strips));
  return list;
}

/// The buffer holds the bytes of the strip with this index. Returns the width of its two images,
/// the size of each inflated stream, and the pieces of each zlib stream in these bytes; null if
/// they are damaged.
Json deflated_images(Engine& engine, const Json& index) {
  const auto strip =
      deflated_strip(engine.early_texels.strips()[index.get<std::size_t>()], engine.buffer);
  if (!strip) return nullptr;
  const auto pieces_of = [&](const DeflatedPng& image) {
    Json pieces = Json::array();
    for (const auto& piece : image.pieces)
      pieces.push_back(
          range_json({std::uint64_t(piece.data() - engine.buffer.data()), piece.size()}));
    return pieces;
  };
  return object({{"width", strip->low.width},
                 {"inflated", strip->low.inflated_bytes()},
                 {"images", Json{pieces_of(strip->low), pieces_of(strip->high)}}});
}

/// {"width"}: of both images of the next strip. The buffer holds their inflated streams, which have
/// the same size. Decodes the texels for "read"; returns whether they are intact.
Json add_texels(Engine& engine, const Json& arguments) {
  const std::span<std::byte> streams = engine.buffer;
  const std::size_t half = streams.size() / 2;
  return engine.early_texels.add(arguments.at("width"), streams.first(half), streams.subspan(half));
}

/// The highest level of the scene's lattices, or null.
Json lattice_level(Engine& engine, const Json&) {
  Json highest;
  for (const PlacedLayer& layer : placed_layers(engine.loader.scene.value())) {
    const auto* texture =
        layer.soup ? std::get_if<LatticeTexture>(&layer.soup->appearance) : nullptr;
    if (!texture) continue;
    std::uint32_t level = highest.is_null() ? 0 : highest.get<std::uint32_t>();
    for (const LatticePatch& patch : texture->patches) level = std::max(level, patch.level);
    highest = level;
  }
  return highest;
}

}  // namespace

Commands loader_commands() {
  return {{"read", read},
          {"preview_size", preview_size},
          {"preview", preview},
          {"begin_texels", begin_texels},
          {"deflated_images", deflated_images},
          {"add_texels", add_texels},
          {"prepare", prepare},
          {"forecast", forecast},
          {"read_block", does(read_block)},
          {"lattice_level", lattice_level}};
}

}  // namespace tureen::web
