// Reads a scene and prepares it for the device of another instance.
#include <algorithm>
#include <optional>

#include "camera/up_axis.hpp"
#include "formats/scene_file.hpp"
#include "formats/tureen_glb/tureen_glb_preview.hpp"
#include "runtime/debug_views/debug_view.hpp"
#include "runtime/render_options.hpp"
#include "scene/edit/edits.hpp"
#include "web/engine/commands.hpp"
#include "web/engine/page_options.hpp"
#include "web/engine/prepared_archive.hpp"
#include "web/engine/scene_path.hpp"

namespace tureen::web {

namespace {

struct Loader {
  std::optional<Scene> scene;
  std::optional<TriangleSoup> reduced;    // at a lower lattice level, to save memory
  std::optional<PreparedScene> prepared;  // reads the scene's soup, or the reduced one

  const TriangleSoup& soup() const { return only_soup(*scene); }
};

Loader& loader() {
  static Loader one;
  return one;
}

Json debug_views_of(const TriangleSoup& soup) {
  Json list = Json::array();
  for (const DebugViewName& name : debug_view_names()) {
    const auto reason = why_not(name.what, soup);
    list.push_back({{"name", name.name},
                    {"title", name.title},
                    {"meaning", name.meaning},
                    {"missing", reason ? Json(*reason) : Json()}});
  }
  return list;
}

/// The remarks without the program's options: a page has no options.
Json notes_of(const Scene& scene) {
  Json notes = scene.info.notes;
  for (const Remark& remark : scene.info.remarks) notes.push_back(describe(remark));
  return notes;
}

Json describe(const Scene& scene) {
  const auto& soup = only_soup(scene);
  Subject subject = tureen::subject_of(scene);
  const UpGuess up = guess_up(evidence_of(scene, subject));
  subject.up = up.axis;
  Json cameras = Json::array();
  for (const Camera& camera : scene.cameras) cameras.push_back(to_json(camera));
  return {{"name", scene.info.name},
          {"source", scene.info.source},
          {"notes", notes_of(scene)},
          {"triangles", soup.triangles.size()},
          {"appearance", appearance_name(soup.appearance)},
          {"cameras", cameras},
          {"background", to_json(glm::dvec3(scene.info.background))},
          {"subject", to_json(subject)},
          {"up_reason", describe(up)},
          {"debug_views", debug_views_of(soup)},
          {"feature_count", feature_count(soup)}};
}

Json take(Scene scene) {
  loader().prepared.reset();
  loader().reduced.reset();
  loader().scene = std::move(scene);
  make_opaque(*loader().scene);
  return describe(*loader().scene);
}

/// {"folder", "paths"}: reads any scene from the file system of this instance.
Json read(const Json& arguments) {
  ReadOptions options;
  options.progress = report_progress;
  return take(read_scene(scene_path(arguments), options));
}

/// {"name"}; the buffer holds the first bytes of a file. Returns the number of bytes for a preview;
/// 0 if the file has none, null if more bytes are needed to decide.
Json preview_size(const Json& arguments) {
  const auto size = tureen_glb_preview_size(buffer(), arguments.at("name").get<std::string>());
  return size ? Json(*size) : Json();
}

/// {"name"}; the buffer holds the number of bytes from "preview_size".
Json preview(const Json& arguments) {
  auto scene = read_tureen_glb_preview(buffer(), arguments.at("name").get<std::string>());
  return scene ? take(std::move(*scene)) : Json();
}

/// {"limits", "level"?: maximum lattice level}. Writes the head to the buffer and returns the
/// blobs.
Json prepare(const Json& arguments) {
  const Scene& scene = loader().scene.value();
  loader().prepared.reset();
  loader().reduced.reset();
  if (const auto level = arguments.find("level"); level != arguments.end())
    loader().reduced =
        edited(loader().soup(), {.lattice_level = level->get<int>()}, report_progress);
  loader().prepared = prepare_scene(loader().reduced ? *loader().reduced : loader().soup(),
                                    origin_of(only_layer(scene)), limits_of(arguments.at("limits")),
                                    page_options(scene));
  buffer() = pack_head(*loader().prepared);
  Json blobs = Json::array();
  for (std::size_t i = 0; i < blob_count(*loader().prepared); ++i)
    blobs.push_back(
        {{"size", blob_size(*loader().prepared, i)}, {"grain", blob_grain(*loader().prepared, i)}});
  return blobs;
}

/// {"blob", "offset", "size"}: writes the bytes to the buffer.
Json read_block(const Json& arguments) {
  buffer().resize(arguments.at("size").get<std::size_t>());
  read_blob(loader().prepared.value(), arguments.at("blob"), arguments.at("offset"), buffer());
  return nullptr;
}

/// The highest level of the scene's lattice, or null.
Json lattice_level(const Json&) {
  const auto* texture = std::get_if<LatticeTexture>(&loader().soup().appearance);
  if (!texture) return nullptr;
  std::uint32_t level = 0;
  for (const LatticePatch& patch : texture->patches) level = std::max(level, patch.level);
  return level;
}

}  // namespace

Commands loader_commands() {
  return {{"read", read},       {"preview_size", preview_size}, {"preview", preview},
          {"prepare", prepare}, {"read_block", read_block},     {"lattice_level", lattice_level}};
}

}  // namespace tureen::web
