#include "viewer/scene/saving.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

#include "base/error.hpp"
#include "base/extension.hpp"
#include "base/input.hpp"
#include "base/output_path.hpp"
#include "formats/glb/glb_container.hpp"
#include "formats/scene_file.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "scene/scene_remarks.hpp"
#include "viewer/names.hpp"

namespace tureen::viewer {

namespace {

namespace fs = std::filesystem;

bool is_glb_name(const fs::path& file) { return extension_of(file) == ".glb"; }

/// Whether the format of this name stores several layers.
bool holds_layers(const fs::path& file) {
  const std::vector<FormatInfo> formats = known_formats();
  return std::any_of(formats.begin(), formats.end(), [&](const FormatInfo& format) {
    const auto& extensions = format.written_extensions;
    return format.holds_layers &&
           std::find(extensions.begin(), extensions.end(), extension_of(file)) != extensions.end();
  });
}

/// The scene without primitives. Remarks about combining files do not concern the saved one.
Scene header_of(const SceneSource& source) {
  Scene scene = *source.scene;
  const Document& document = source.document;
  std::erase_if(scene.info.remarks, [](const Remark& remark) {
    return remark.kind == &remarks::settings_dropped || remark.kind == &remarks::turned_upright;
  });
  scene.layers.clear();
  for (const DocumentLayer& layer : document.layers)
    scene.layers.push_back(
        {layer.name, layer.world_from_layer, layer.visible, TriangleSoup{}, layer.material});
  // A file of one layer without a name stays one.
  if (const auto& layers = document.layers; layers.size() == 1) {
    const auto origin = source.origins.find(layers[0].id);
    if (origin != source.origins.end() && origin->second.name == layers[0].name)
      scene.layers[0].name = source.as_read(layers[0])->name;
  }
  scene.quality = document.quality;
  if (document.background) scene.info.background = *document.background;
  if (document.first_view) scene.first_view = document.first_view;
  choose_up(scene.info, glm::vec3(document.up));
  return scene;
}

}  // namespace

Scene scene_of(const SceneSource& source) {
  Scene scene = header_of(source);
  for (std::size_t i = 0; i < scene.layers.size(); ++i)
    scene.layers[i].primitives = *source.document.layers[i].primitives;
  if (source.document.profile && has_splats(source))
    choose_profile(scene, name_of(*source.document.profile));
  return scene;
}

bool can_be_replaced(const SceneFile& file) {
  try {
    require_written_format(file.path);
    if (!fs::is_regular_file(file.path)) return false;
    if (!is_glb_name(file.path)) {
      const std::vector<Remark>& remarks = file.header->info.remarks;
      return std::none_of(remarks.begin(), remarks.end(), [](const Remark& remark) {
        return remark.kind->severity == RemarkKind::Severity::loss;
      });
    }
    Input input = Input::open(file.path);
    return is_glb(input) && is_tureen_glb(read_glb_container(input));
  } catch (const Error&) {
    return false;
  } catch (const fs::filesystem_error&) {
    return false;
  }
}

fs::path proposed_file(const SceneSource& source) {
  std::error_code unknown;
  fs::path file = fs::absolute(source.path(), unknown);
  if (!file.has_filename()) file = file.parent_path();  // "export/"
  const fs::path stem = file.stem();
  for (int number = 1;; ++number) {
    file.replace_filename(stem.string() + (number == 1 ? "" : "-" + std::to_string(number)) +
                          ".glb");
    if (!fs::exists(file, unknown)) return file;
  }
}

std::string written_extensions(const SceneSource& source) {
  const bool has_layers = source.document.layers.size() > 1;
  std::string list;
  for (const FormatInfo& format : known_formats())
    for (const std::string& extension : format.written_extensions)
      if (extension != ".glb" && (format.holds_layers || !has_layers))
        list += (list.empty() ? "" : ", ") + extension;
  return ".glb stores everything; other formats: " + list + ".";
}

std::string name_defect(const SceneSource& source, const fs::path& file) {
  if (!file.has_filename() || file.extension().empty())
    return "The name needs an extension: .glb stores everything.";
  try {
    require_written_format(file);
    if (source.document.layers.size() > 1 && !holds_layers(file))
      return "This format stores one layer: choose .glb, or remove all other layers.";
    writable_file(file);
  } catch (const Error& error) {
    return error.what();
  }
  std::error_code unknown;
  const fs::path folder = fs::absolute(file, unknown).parent_path();
  return fs::is_directory(folder, unknown) ? "" : "There is no folder " + folder.string() + ".";
}

Saved save_scene(const SceneSource& source, const fs::path& file, bool accepts_losses,
                 const std::function<void(double)>& progress) {
  const fs::path target = writable_file(file);
  const Scene scene = scene_of(source);
  Saved saved;
  if (is_glb_name(file)) {
    saved.lost = write_scene(scene, target, {.progress = progress});
    saved.is_written = true;
  } else {  // writing finds the losses
    fs::path name = temporary_beside(target);
    name += target.filename();  // with both extensions of .compressed.ply
    const TemporaryFile temporary(name);
    saved.lost = write_scene(scene, name);
    if (is_quantised(file))
      saved.lost.emplace_back("The format rounds splats. tureen convert measures by how much.");
    if (progress) progress(1);
    saved.is_written = accepts_losses || saved.lost.empty();
    std::error_code failed;
    if (saved.is_written) fs::rename(name, target, failed);
    if (failed)
      throw OutputError({file.string(), {}, {}}, "cannot be replaced: " + failed.message());
  }
  Scene header = header_of(source);
  if (!is_glb_name(file)) header.layers.clear();
  std::erase_if(header.info.remarks, names_levels);  // the saved file has none to choose
  saved.file = {file, FileWatch(file), std::make_shared<const Scene>(std::move(header))};
  return saved;
}

void adopt_file(SceneSource& source, const SceneSource& saved, SceneFile file) {
  source.origins.clear();
  for (std::size_t i = 0; i < file.header->layers.size(); ++i) {
    const DocumentLayer& layer = saved.document.layers[i];
    source.origins[layer.id] = {0, i, layer.name};
  }
  source.scene = file.header;
  source.files = {std::move(file)};
  source.up = {.axis = saved.document.up, .reason = UpGuess::Reason::stored};
  update_subject(source);
}

}  // namespace tureen::viewer
