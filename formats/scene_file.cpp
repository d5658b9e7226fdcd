// The table of formats, and the functions that search it. A new format needs one entry.
//
// The page's own program is compiled with TUREEN_FEW_FORMATS: what a page shows most often, and no
// writers. Its second program, which it loads for the others, has all but the writers that compress
// by native libraries.
#include "formats/scene_file.hpp"

#include <algorithm>
#include <span>

#include "base/extension.hpp"
#include "base/input.hpp"
#include "formats/common/format_remarks.hpp"
#include "formats/diffsoup/diffsoup_export.hpp"
#include "formats/gltf/gltf.hpp"
#include "formats/gltf_file.hpp"
#include "formats/mesh/mobilenerf.hpp"
#include "formats/mesh/obj.hpp"
#include "formats/mesh/off.hpp"
#include "formats/mesh/plain_mesh.hpp"
#include "formats/mesh/stray_content.hpp"
#include "formats/ply/ply_header.hpp"
#include "formats/ply_file.hpp"
#include "formats/sog/sog.hpp"
#include "formats/splat/compressed_ply.hpp"
#include "formats/splat/ksplat.hpp"
#include "formats/splat/octagon_npz.hpp"
#include "formats/splat/splat_records.hpp"
#include "formats/splat/splat_writing.hpp"
#include "formats/splat/spz.hpp"
#include "formats/torch/checkpoint.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "formats/usd/usd.hpp"
#include "scene/edit/splat_limit.hpp"
#include "scene/near_limit.hpp"

namespace tureen {

namespace {

/// A path before a reader is chosen.
struct Candidate {
  std::filesystem::path path;
  bool is_folder = false;
  std::span<const std::byte> head;  // the first head_size bytes of a file, or all
};

/// In bytes: enough for the longest signature, and for comments before the header word of an OFF.
constexpr std::size_t head_size = 4096;

struct Format {
  const char* name = "";
  const char* description = "";
  std::vector<const char*> read_extensions{}, written_extensions{};  // lower case
  bool is_folder = false;  // as it is read; written if there are no written extensions
  bool (*recognises)(const Candidate&) = nullptr;
  Scene (*read)(const std::filesystem::path&, const ReadOptions&) = nullptr;  // null: write only
  std::vector<std::string> (*write)(const Scene&, const std::filesystem::path&,
                                    const WriteOptions&) = nullptr;
  glm::vec3 (*assumed_up)(const Scene&) = nullptr;  // null: files store the up axis
  bool is_quantised = false;                        // rounds splats so that images show it
  bool holds_layers = false;                        // several
};

#ifdef __EMSCRIPTEN__
[[maybe_unused]] constexpr bool in_browser = true;
#else
constexpr bool in_browser = false;
#endif

/// A writer without options. Without the writers, the page's own program is 4 % smaller.
#ifdef TUREEN_FEW_FORMATS
template <auto Write>
constexpr decltype(Format::write) plainly = nullptr;
constexpr decltype(Format::write) write_glb = nullptr;
#else
template <auto Write>
constexpr decltype(Format::write) plainly = [](const Scene& scene,
                                               const std::filesystem::path& path,
                                               const WriteOptions&) { return Write(scene, path); };
std::vector<std::string> write_glb(const Scene& scene, const std::filesystem::path& path,
                                   const WriteOptions& options) {
  return write_tureen_glb(scene, path, options.progress);
}
#endif

/// A writer that compresses by libraries which pages lack.
#ifdef __EMSCRIPTEN__
template <auto Write>
constexpr decltype(Format::write) natively = nullptr;
#else
template <auto Write>
constexpr decltype(Format::write) natively = plainly<Write>;
std::vector<std::string> write_chosen_spz(const Scene& scene, const std::filesystem::path& path,
                                          const WriteOptions& options) {
  return write_spz(scene, path, options.spz_version);
}
#endif

Scene read_any_gltf(const std::filesystem::path& path, const ReadOptions& options) {
#if defined(TUREEN_FEW_FORMATS)
  const ReadSpz spz = [](Input& input, const ReadOptions&) -> Scene {
    throw ReadElsewhere({input.name()},
                        "this page does not read SPZ in glTF; convert it to GLB: "
                        "tureen convert FILE.glb OUT.glb");
  };
  return read_gltf_or_glb(path, options, {.spz = spz});
#elif defined(__EMSCRIPTEN__)
  return read_gltf_or_glb(path, options, {.spz = read_spz});
#else
  return read_gltf_or_glb(path, options);
#endif
}

glm::vec3 up_of_splats(const Scene&) { return splat_up; }

/// In the order of recognition: the first format that recognises a file reads it.
const std::vector<Format>& formats() {
  static const std::vector<Format> table{
      {.name = "GLB",
       .description = "Tureen's own format, streamable and exact; any glTF viewer shows its mean "
                      "colours. With --compress: lossy, for Tureen only",
       .read_extensions = {".glb", ".gltf"},
       .written_extensions = {".glb"},
       .recognises = [](const Candidate& c) { return !c.is_folder && is_gltf(c.head); },
       .read = read_any_gltf,
       .write = write_glb,
       .holds_layers = true},
      {.name = "OFF",
       .description = "triangles with one colour per face or vertex, as text",
       .read_extensions = {".off", ".coff"},
       .written_extensions = {".off", ".coff"},
       .recognises = [](const Candidate& c) { return !c.is_folder && is_off(c.head); },
       .read = read_off,
       .write = plainly<write_off>,
       .assumed_up = [](const Scene&) { return assumed_up; }},
#ifndef TUREEN_FEW_FORMATS
      // Before PLY, which reads it: it is chosen by its longer extension.
      {.name = "compressed PLY",
       .description = "Gaussians and discs in 16 bytes, and harmonics in bytes (PlayCanvas)",
       .written_extensions = {".compressed.ply"},
       .recognises = [](const Candidate&) { return false; },
       .write = plainly<write_compressed_ply>,
       .assumed_up = up_of_splats,
       .is_quantised = true},
#endif
      {.name = "PLY",
       .description = "triangles with one colour per face or vertex, or splats (3DGS, 2DGS, GaMeS, "
                      "SplatNet)",
       .read_extensions = {".ply"},
       .written_extensions = {".ply"},
       .recognises = [](const Candidate& c) { return !c.is_folder && is_ply(c.head); },
       .read = read_ply,
       .write = plainly<write_ply>,
       .assumed_up = assumed_up_of_ply},
      {.name = "DiffSoup export",
       .description = "lattice textures and a color MLP, for the web",
       .is_folder = true,
       .recognises = [](const Candidate& c) { return c.is_folder && is_diffsoup_export(c.path); },
       .read = read_diffsoup_export,
       .write = plainly<write_diffsoup_export>},
#ifndef TUREEN_FEW_FORMATS
      {.name = "octagon mesh",
       .description = "REdiSplats: octagons as flat Gaussians",
       .read_extensions = {".npz"},
       .written_extensions = {".npz"},
       .recognises = [](const Candidate& c) { return !c.is_folder && is_octagon_npz(c.head); },
       .read = read_octagon_npz,
       .write = natively<write_octagon_npz>,
       .assumed_up = up_of_splats},
      {.name = "USD",
       .description = "Gaussians and discs as fields of particles (UsdVol), as text; experimental",
       .read_extensions = {".usda", ".usdz", ".usd", ".usdc"},
       .written_extensions = {".usda", ".usdz"},
       .recognises = [](const Candidate& c) { return !c.is_folder && is_usd(c.head); },
       .read = read_usd,
       .write = natively<write_usd>,
       .holds_layers = true},
      {.name = "SOG",
       .description = "Gaussians as lossless WebP images, also streamed with levels of detail; a "
                      "folder, its meta.json or lod-meta.json, or an archive",
       .read_extensions = {".sog", ".ssog"},
       .written_extensions = {".sog"},
       .is_folder = true,
       .recognises = [](const Candidate& c) { return is_sog(c.path, c.head); },
       .read = read_sog,
       .write = natively<write_sog>,
       .assumed_up = up_of_splats,
       .is_quantised = true},
      {.name = "checkpoint",
       .description = "Torch: DiffSoup, Triangle Splatting, Triangle Splatting+, MeshSplatting",
       .read_extensions = {".pt"},
       .recognises = [](const Candidate& c) { return !c.is_folder && is_checkpoint(c.head); },
       .read = read_checkpoint},
      {.name = "SPZ",
       .description = "Gaussians, quantised and compressed",
       .read_extensions = {".spz"},
       .written_extensions = {".spz"},
       .recognises = [](const Candidate& c) { return !c.is_folder && is_spz(c.head); },
       .read = read_spz,
#ifndef __EMSCRIPTEN__
       .write = write_chosen_spz,
#endif
       .assumed_up = up_of_splats,
       .is_quantised = true},
      {.name = ".ksplat",
       .description = "Gaussians in buckets (GaussianSplats3D)",
       .read_extensions = {".ksplat"},
       .recognises = [](const Candidate& c) { return !c.is_folder && is_ksplat(c.path); },
       .read = read_ksplat},
#endif
      {.name = ".splat",
       .description = "Gaussians of one colour in records of 32 bytes, without a header",
       .read_extensions = {".splat"},
       .written_extensions = {".splat"},
       .recognises =
           [](const Candidate& c) { return !c.is_folder && is_splat_records(c.path, c.head); },
       .read = read_splat_records,
       .write = plainly<write_splat_records>,
       .assumed_up = up_of_splats,
       .is_quantised = true},
#ifndef TUREEN_FEW_FORMATS
      {.name = "MobileNeRF",
       .description = "a folder of shapes with feature textures and a color MLP, or a file in it",
       .read_extensions =
           in_browser ? std::vector<const char*>{".obj"} : std::vector<const char*>{},
       .is_folder = true,
       .recognises = [](const Candidate& c) { return is_mobilenerf(c.path); },
       .read = read_mobilenerf},
#endif
#ifndef __EMSCRIPTEN__
      // After MobileNeRF, which reads its shapes.
      {.name = "OBJ",
       .description = "triangles with vertex colours, material colours and textures",
       .read_extensions = {".obj"},
       .written_extensions = {".obj"},
       // No content is a sign of it.
       .recognises =
           [](const Candidate& c) {
             return !c.is_folder && extension_of(c.path) == ".obj" && !stray_content(c.head);
           },
       .read = read_obj,
       .write = plainly<write_obj>,
       .assumed_up = [](const Scene&) { return obj_up; }},
#endif
  };
  return table;
}

bool contains(const std::vector<const char*>& extensions, const std::string& extension) {
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

enum class Direction { read, written };

/// The formats of one direction: "OFF (.off), PLY (.ply) and DiffSoup export (folder)".
std::string listed(Direction direction) {
  std::vector<std::string> names;
  for (const Format& format : formats()) {
    const bool is_read = direction == Direction::read;
    if (is_read ? !format.read : !format.write) continue;
    const bool is_folder = is_read ? format.is_folder : format.written_extensions.empty();
    std::string kinds = is_folder ? "folder" : "";
    for (const char* extension : is_read ? format.read_extensions : format.written_extensions)
      kinds += (kinds.empty() ? "" : ", ") + std::string(extension);
    names.push_back(std::string(format.name) + " (" + kinds + ")");
  }
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  return text;
}

/// `head` receives the file's first bytes and must outlive the candidate.
Candidate candidate_at(const std::filesystem::path& path, std::vector<std::byte>& head) {
  std::error_code ignored;  // Input::open reports an invalid path
  Candidate candidate{path, std::filesystem::is_directory(path, ignored), {}};
  if (candidate.is_folder) return candidate;
  Input input = Input::open(path);
  head.resize(head_size);
  candidate.head = std::span(head).first(input.read_some(head));
  return candidate;
}

/// The format by content. If no format recognises the content, the format by extension, so that its
/// reader reports the fault.
const Format& format_to_read(const Candidate& candidate) {
  for (const Format& format : formats())
    if (format.read && format.recognises(candidate)) return format;
  const std::string extension = extension_of(candidate.path);
#ifdef TUREEN_FEW_FORMATS
  // Reached only by a page that cannot load the second program, such as one in a single file.
  for (const char* elsewhere :
       {".sog", ".ssog", ".spz", ".ksplat", ".usda", ".usdz", ".npz", ".pt", ".obj"})
    if (extension == elsewhere && !candidate.is_folder)
      throw InputError({candidate.path.string()},
                       "this page does not read " + extension + " files; convert it to GLB: " +
                           "tureen convert FILE" + extension + " FILE.glb");
#endif
  if (const auto stray = stray_content(candidate.head); stray && !candidate.is_folder)
    throw InputError({candidate.path.string()}, stray->reason, stray->hint);
  for (const Format& format : formats())
    if (format.read && !candidate.is_folder && contains(format.read_extensions, extension))
      return format;
  throw InputError({candidate.path.string()},
                   std::string("not a ") + (candidate.is_folder ? "folder" : "file") +
                       " in a supported format: " + listed(Direction::read));
}

/// The reason for rejecting a scene without primitives.
std::string nothing_in(const Scene& scene) {
  for (const Layer& layer : scene.layers)
    if (std::holds_alternative<Splats>(layer.primitives)) {
      for (const Remark& remark : scene.info.remarks)
        if (remark.kind == &remarks::splats_dropped) return describe(remark);
      return "the file holds no splats";
    }
  return "the file holds no triangles";
}

/// The longest extension of a format with which the name ends, such as .compressed.ply; otherwise
/// the last one.
std::string written_extension(const std::filesystem::path& path) {
  std::string name = path.filename().string(), found = extension_of(path);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  for (const Format& format : formats())
    for (const std::string extension : format.written_extensions)
      if (extension.size() > found.size() && name.ends_with(extension)) found = extension;
  return found;
}

/// The format by extension.
const Format& format_to_write(const std::filesystem::path& path) {
  const std::string extension = written_extension(path);
  // A .gltf would store its bytes in a second file.
  if (extension == ".gltf") throw UsageError("glTF is written as .glb only");
  for (const Format& format : formats())
    if (format.write && (extension.empty() ? format.written_extensions.empty()
                                           : contains(format.written_extensions, extension)))
      return format;
  throw UsageError((extension.empty() ? "the output name has no extension, so its format is unknown"
                                      : "no output format has the extension " + extension),
                   "supported output formats: " + listed(Direction::written));
}

}  // namespace

bool is_scene(const std::filesystem::path& path) {
  std::vector<std::byte> head;
  const Candidate candidate = candidate_at(path, head);
  return std::any_of(formats().begin(), formats().end(), [&](const Format& format) {
    return format.read && format.recognises(candidate);
  });
}

Scene read_scene(const std::filesystem::path& path, const ReadOptions& options) {
  std::vector<std::byte> head;
  const Candidate candidate = candidate_at(path, head);
  const Format& format = format_to_read(candidate);
  Scene scene = format.read(path, options);

  const std::string extension = extension_of(path);
  const auto promises = [&](const Format& other) {
    return contains(other.read_extensions, extension);
  };
  if (!candidate.is_folder && !promises(format) &&
      std::any_of(formats().begin(), formats().end(), promises))
    scene.info.remarks.push_back(
        {&remarks::content_misnamed, {{"extension", extension}, {"format", format.name}}});
  bool is_empty = true;
  for (const Layer& layer : scene.layers) {
    const auto* soup = std::get_if<TriangleSoup>(&layer.primitives);
    const auto reason = soup ? defect(*soup) : defect(std::get<Splats>(layer.primitives));
    if (reason) throw InputError({path.string()}, *reason);
    if (soup ? !soup->triangles.empty() : count(std::get<Splats>(layer.primitives)) > 0)
      is_empty = false;
  }
  if (is_empty) throw InputError({path.string()}, nothing_in(scene));
  if (options.max_splats) limit_splats(scene, *options.max_splats);
  if (const auto remark = near_limit_remark(scene)) scene.info.remarks.push_back(*remark);
  return scene;
}

void require_written_format(const std::filesystem::path& path) { format_to_write(path); }

std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& path,
                                     const WriteOptions& options) {
  return format_to_write(path).write(scene, path, options);
}

std::optional<glm::vec3> assumed_up_of(const Scene& scene, const std::filesystem::path& path) {
  const Format& format = format_to_write(path);
  if (!format.assumed_up) return std::nullopt;
  return format.assumed_up(scene);
}

bool is_quantised(const std::filesystem::path& path) { return format_to_write(path).is_quantised; }

std::vector<FormatInfo> known_formats() {
  std::vector<FormatInfo> infos;
  for (const Format& format : formats())
    infos.push_back({format.name,
                     format.description,
                     {format.read_extensions.begin(), format.read_extensions.end()},
                     {format.written_extensions.begin(), format.written_extensions.end()},
                     format.is_folder,
                     format.read != nullptr,
                     format.write != nullptr,
                     format.holds_layers});
  return infos;
}

}  // namespace tureen
