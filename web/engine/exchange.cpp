// Commands of the page's second program, which has all formats: which files of a scene are missing,
// and files for the user.
#include <algorithm>
#include <array>
#include <glm/vec3.hpp>
#include <utility>

#include "base/input.hpp"
#include "base/output.hpp"
#include "formats/scene_file.hpp"
#include "formats/sog/sog.hpp"
#include "web/engine/engine.hpp"
#include "web/engine/scene_path.hpp"

namespace tureen::web {

namespace {

bool is_sog_at(const std::filesystem::path& path) {
  std::array<std::byte, 4096> head;
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return is_sog(path, {});
  Input input = Input::open(path);
  return is_sog(path, std::span(head).first(input.read_some(head)));
}

/// {"folder", "paths", "memory", "max_splats"?, "lod"?}. Returns {"levels": splats by level of
/// detail, "level", "missing": names to fetch before "read"; further ones may follow}. The level is
/// `lod`, or the finest that fits; the splats are counted with harmonics of degree 3.
Json plan_files(Engine&, const Json& arguments) {
  const std::filesystem::path path = scene_path(arguments);
  ReadOptions options = read_options(arguments);
  if (!options.max_splats) {
    const double each = load_bytes(1, double(bytes_per_splat(Gaussians{}, 3)));
    constexpr double most = 1e18;  // fits the type; a caller may have no limit
    options.max_splats =
        std::uint64_t(std::min(arguments.at("memory").get<double>() / each, most)) + 1;
  }
  const SogNeeds needs = is_sog_at(path) ? sog_needs(path, options) : SogNeeds{};
  return object({{"levels", needs.levels}, {"level", needs.level}, {"missing", needs.missing}});
}

/// The scenes that "read_for_debug_views" has read, as one: these layers, with their places in the
/// page's document, or a single scene as it is. Cameras and quality are those of the first.
Scene scene_of(std::vector<Scene> sources, const Json& document) {
  if (document.is_null()) return std::move(sources.at(0));
  Scene scene = std::move(sources.at(0));
  std::vector<Layer> firsts = std::exchange(scene.layers, {});
  const Json& layers = document.at("layers");
  for (const Json& shown : layers) {
    const std::size_t source = shown.at("source");
    Layer& layer =
        (source == 0 ? firsts : sources.at(source).layers).at(shown.at("index").get<std::size_t>());
    if (layers.size() > 1) layer.name = shown.at("name").get<std::string>();
    layer.world_from_layer = matrix_of(shown.at("transform"));
    layer.visible = shown.at("visible").get<bool>();
    scene.layers.push_back(std::move(layer));  // each is in the document once
  }
  if (const glm::vec3 up(vector_of(document.at("up"))); up != scene.info.up)
    choose_up(scene.info, up);
  scene.info.background = glm::vec3(vector_of(document.at("background")));
  if (const Json& view = document.at("view"); !view.is_null()) scene.first_view = camera_of(view);
  return scene;
}

/// {"file": path in this instance, "document": {"layers": [{"source", "index", "name", "transform",
/// "visible"}, ..], "up", "background", "view": camera or null}, or null}: writes what
/// "read_for_debug_views" has read. Returns a sentence for each loss.
Json write(Engine& engine, const Json& arguments) {
  const std::filesystem::path file = arguments.at("file").get<std::string>();
  make_folder(file.parent_path());
  const Scene scene = scene_of(std::exchange(engine.reread, {}), arguments.at("document"));
  return write_scene(scene, file, {.progress = report_progress});
}

}  // namespace

Commands exchange_commands() { return {{"plan_files", plan_files}, {"write", write}}; }

}  // namespace tureen::web
