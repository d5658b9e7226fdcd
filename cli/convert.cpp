// `tureen convert`: a scene in another format.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>

#include "base/error.hpp"
#include "base/extension.hpp"
#include "cli/commands.hpp"
#include "cli/convert_compress.hpp"
#include "cli/files/scene_page.hpp"
#include "cli/files/scratch.hpp"
#include "cli/interrupt.hpp"
#include "cli/options/edit_options.hpp"
#include "cli/options/material_option.hpp"
#include "cli/options/memory_option.hpp"
#include "cli/options/output_argument.hpp"
#include "cli/options/scene_argument.hpp"
#include "cli/options/values.hpp"
#include "cli/options/view_options.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "jobs/conversion/conversion_loss.hpp"
#include "scene/edit/moved_scene.hpp"
#include "scene/similarity.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

struct ConvertOptions {
  /// IN OUT, or with -o scenes only: positional arguments in the order of the command line.
  std::string first, second;
  std::vector<std::string> further;
  SceneArguments scene;  // its paths are empty until sort_arguments()
  std::string output;
  bool output_is_argument = false;  // without -o
  std::string layer;                // the only layer to write; empty: all
  Similarity move = {};             // of the whole scene
  bool moves = false;
  std::string view;  // the first view to store: an index or "FILE:3"; empty: the scene's own
  bool force = false;
  bool json = false;
  bool no_measure = false;
  WriteOptions writing;
  Edits edits;
  QualityOptions quality;
  MaterialChoices materials;
  CompressArguments compressed;
};

/// Sets the paths of the scenes and the output.
void sort_arguments(ConvertOptions& options) {
  std::vector<std::string>& paths = options.scene.paths;
  paths = {options.first};
  if (options.output.empty()) {
    if (options.second.empty()) throw UsageError("OUT is required");
    if (!options.further.empty())
      throw UsageError("several scenes need -o OUT",
                       "tureen convert A.glb B.glb -o OUT.glb makes them the layers of one scene");
    options.output = options.second;
    options.output_is_argument = true;
    return;
  }
  if (!options.second.empty()) paths.push_back(options.second);
  paths.insert(paths.end(), options.further.begin(), options.further.end());
}

/// An output without an extension is a folder.
bool is_export(const fs::path& output) { return output.extension().empty(); }

/// Whether the name is only an extension, such as ".ply"; as a path it is a hidden folder.
bool is_bare_extension(const fs::path& output) {
  const std::string name = output.filename().string();
  const auto formats = known_formats();
  return name == ".html" || std::any_of(formats.begin(), formats.end(), [&](const FormatInfo& f) {
           return std::count(f.read_extensions.begin(), f.read_extensions.end(), name) > 0;
         });
}

void require_known_extension(const fs::path& output) {
  if (is_scene_page(output)) return;
  if (is_bare_extension(output))
    throw UsageError("'" + output.string() + "' has no name before its extension");
  try {
    require_written_format(output);
  } catch (const UsageError& error) {
    throw UsageError(error.reason(),
                     (error.hint().empty() ? "" : error.hint() + "; ") + "a page ends in .html");
  }
}

/// Whether the output, which exists, is a scene.
bool is_readable_scene(const fs::path& output) {
  try {
    return is_scene(output);
  } catch (const InputError&) {
    return false;
  }
}

/// Throws UsageError and OutputError. Runs before the scene is read, because reading may take
/// minutes.
void check_output(const ConvertOptions& options) {
  const fs::path output = options.output;
  check_compressed(options.compressed, output);
  require_known_extension(output);
  if ((options.quality.any() || !options.materials.empty()) && extension_of(output) != ".glb" &&
      !is_scene_page(output))
    throw UsageError(
        "only .glb and .html store --supersample, --resolution-scale, --splat-order and "
        "--material");
  if (!options.view.empty() && extension_of(output) != ".glb" && !is_scene_page(output))
    throw UsageError("only .glb and .html store a first view (--view)");
  require_not_inputs(output, options.scene);
  // These checks do not depend on --force.
  if (is_export(output))
    require_writable_export(output);
  else
    require_writable_file(output);
  std::error_code error;
  if (fs::exists(output, error) && !options.force)
    throw UsageError(options.output + " exists",
                     options.output_is_argument && is_readable_scene(output)
                         ? "to write one scene from all of them, add -o OUT.glb; to replace " +
                               options.output + ", add --force"
                         : "choose another name, or replace it with --force");
}

void apply(const Edits& edits, Scene& scene) {
  if (edits == Edits{}) return;
  auto* soup = std::get_if<TriangleSoup>(&only_layer(scene).primitives);
  if (!soup || !std::holds_alternative<LatticeTexture>(soup->appearance))
    throw UsageError(std::string("--lattice-level, --color and --texel-bits change lattice "
                                 "textures; this scene has ") +
                     (soup ? appearance_name(soup->appearance) : "splats"));
  const Edits changes = effective(edits, *soup);
  if (changes == Edits{}) {
    say("the edits change nothing: the scene is already within these limits");
    return;
  }
  Progress progress("reducing the scene");
  *soup = edited(std::move(*soup), changes, [&](double done) { progress.update(done); });
  scene.info.notes.push_back("reduced by tureen convert: " + describe(changes));
}

/// Moves the scene. A format without an up axis gets it as the axis that its readers assume, if the
/// user has named the axis.
void move(Scene& scene, const ConvertOptions& options) {
  if (options.moves) move_scene(scene, matrix_of(options.move));
  if (options.scene.choice.up.empty() || is_scene_page(options.output)) return;
  const glm::vec3 before = scene.info.up;
  const std::optional<glm::vec3> assumed = assumed_up_of(scene, options.output);
  if (!assumed || glm::distance(before, *assumed) < 1e-6f) return;
  move_scene(scene, glm::dmat4(rotation_between(before, *assumed)));
  scene.info.up = *assumed;
  say(options.output + " stores no up axis: " + axis_name(before) + " is turned to " +
      axis_name(*assumed) + ", which readers assume");
}

/// Sets the first view to the one that `view` names.
void set_first_view(Scene& scene, const std::string& view, const std::string& scene_path) {
  const bool is_index = view.find_first_not_of("0123456789") == view.npos;
  const std::string argument = is_index ? scene_path + ":" + view : view;
  if (is_index && scene.cameras.empty())
    throw UsageError("--view " + view + " is a recorded camera; the scene has none");
  const Views views = recorded_views(argument, "0", scene, scene_path);
  if (views.cameras.size() != 1) throw UsageError("--view " + view + " names several cameras");
  scene.first_view = views.cameras.front();
}

Json figures_of(const Scene& scene, const std::vector<std::string>& lost) {
  return {{"notes", notes_of(scene.info)},
          {"remarks", remarks_json(scene.info.remarks)},
          {"lost", lost}};
}

/// Draws the scene and what was written of it. Prints the loss and adds it to the JSON.
void measure(const Scene& scene, const ConvertOptions& options, const fs::path& file, Json& json) {
  ReadOptions reading;
  reading.octagon_q = options.scene.choice.octagon_q;
  Scene stored = read_scene(file, reading);
  ConversionLoss loss;
  {
    Progress progress("comparing images");
    loss = conversion_loss(scene, stored, [&](double done) { progress.update(done); });
  }
  say(fmt::format(
      "images of {}: PSNR {:.2f} dB against the source over {} views, at least {:.2f} dB",
      options.output, loss.psnr_db, loss.views, loss.worst_psnr_db));
  json["loss"] = {
      {"views", loss.views}, {"psnr_db", loss.psnr_db}, {"worst_psnr_db", loss.worst_psnr_db}};
}

/// Writes `file` in the format of its extension. Prints the losses and returns them as JSON.
Json write(Scene scene, const ConvertOptions& options, const fs::path& file) {
  if (options.compressed.compressed)
    return convert_compressed(std::move(scene), options.compressed, file);
  const std::vector<std::string> lost = write_scene(scene, file, options.writing);
  say_list("Lost in " + options.output + ":", lost);
  Json figures = figures_of(scene, lost);
  if (options.no_measure || !is_quantised(file) || !is_measurable(scene)) return figures;
  try {
    measure(scene, options, file, figures);
  } catch (const Interrupted&) {
    if (file == options.output)
      say("wrote " + options.output + "; interrupted before its loss was measured");
    throw;
  }
  return figures;
}

/// Whether the page can contain the scene's file unchanged.
bool is_page_of_file(const ConvertOptions& options) {
  return !options.compressed.compressed && options.scene.choice == ReadingChoice{} &&
         options.edits == Edits{} && !options.quality.any() && options.materials.empty() &&
         options.layer.empty() && !options.moves && options.view.empty() &&
         options.scene.paths.size() == 1 && is_our_glb(options.scene.paths.front());
}

Json write_page(const ScenePageTemplate& page, Scene scene, const ConvertOptions& options) {
  const fs::path output = options.output;
  const std::string name = scene.info.name.empty() ? output.stem().string() : scene.info.name;
  if (is_page_of_file(options)) {
    page.write(options.scene.paths.front(), name, output);
    return figures_of(scene, {});
  }
  const Scratch glb(options.output + ".glb", "the scene for the page");
  Json figures;
  try {
    figures = write(std::move(scene), options, glb.path());
  } catch (const OutputError& error) {
    throw OutputError({options.output}, error.reason(), error.hint());
  }
  page.write(glb.path(), name, output);
  return figures;
}

ExitCode convert_scene(ConvertOptions options) {
  sort_arguments(options);
  check_output(options);
  std::optional<ScenePageTemplate> page;
  if (is_scene_page(options.output)) page = ScenePageTemplate::find();
  Scene scene = read(options.scene);
  say_list("Reading " + listed(options.scene) + ":", notes_of(scene.info));
  apply_materials(options.materials, scene);
  if (!options.layer.empty()) keep_layer(scene, options.layer);
  apply(options.edits, scene);
  if (triangle_count(scene) + splat_count(scene) == 0)
    throw UsageError("there is nothing to write: no triangles or splats are left");
  options.quality.apply_to(scene.quality);
  move(scene, options);
  if (!options.view.empty()) set_first_view(scene, options.view, options.scene.paths.front());
  const Json figures = page ? write_page(*page, std::move(scene), options)
                            : write(std::move(scene), options, options.output);
  const std::uint64_t bytes = bytes_on_disk(options.output);
  say("wrote " + options.output + ", " + bytes_text(bytes));
  if (options.json) {
    Json json = {{"output", options.output}, {"bytes_on_disk", bytes}};
    json.update(figures);
    print_json(json);
  }
  return ExitCode::done;
}

/// "  .glb         glTF: .." of every format that can be written.
std::string written_formats() {
  std::string text;
  for (const FormatInfo& format : known_formats()) {
    if (!format.can_write) continue;
    std::string extensions = fmt::format("{}", fmt::join(format.written_extensions, ", "));
    if (extensions.empty()) extensions = "(folder)";
    extensions.resize(std::max<std::size_t>(extensions.size() + 1, 16), ' ');
    text += "  " + extensions + format.name + ": " + format.description + "\n";
  }
  return text +
         "  .html           page: Tureen's GLB and the viewer from ./dev web; opens with a double "
         "click\n";
}

void add_moving_options(Command& command, ConvertOptions& options) {
  Similarity& move = options.move;
  const auto moves = [&options] { options.moves = true; };
  command.add_option(
      "--rotate X,Y,Z",
      [&move, moves](const std::string& text) {
        move.angles = parse_vector(text);
        moves();
      },
      "rotate the whole scene with its cameras: degrees about the world's x, then y, then z axis");
  command.add_option(
      "--resize FACTOR",
      [&move, moves](const std::string& text) {
        move.scale = *number_from(text);
        moves();
      },
      "scale the whole scene about the world's origin", between(1e-9, 1e9));
  command.add_option(
      "--translate X,Y,Z",
      [&move, moves](const std::string& text) {
        move.position = parse_vector(text);
        moves();
      },
      "move the whole scene, after --rotate and --resize");
}

}  // namespace

void add_convert(Command& program) {
  auto options = std::make_shared<ConvertOptions>();
  Command command = program.add_command("convert", "Write a scene in another format");
  command.footer(
      "The extension of OUT determines the format:\n" + written_formats() +
      R"(The command omits data that the format cannot store, and prints these losses. If the format rounds
splats, it draws 16 views of the source and of OUT, and prints their PSNR.

With -o OUT, all other arguments are scenes, and each becomes a layer of one scene. Only .glb, .html,
.usda and .usdz store several layers.

Examples:
  tureen convert trained.pt soup.glb          Tureen's own format
  tureen convert soup.glb soup.off --force    replaces soup.off
  tureen convert soup.glb small.glb --compress --photographs lego --scale 0.5
                                              loses at most 0.1 dB on lego
  tureen convert soup.glb less.glb --lattice-level 2
                                              coarser textures; tradeoff measures the error
  tureen convert soup.glb smooth.glb --supersample 2
                                              stores 2 x 2 samples per pixel as a quality setting
  tureen convert house.glb fox.glb tree.ply -o garden.glb
                                              one scene with three layers
  tureen convert garden.glb --layer fox -o one.glb
                                              one layer, at its place
  tureen convert room.glb ball.glb -o both.glb --material ball=glass:1.33
                                              stores the layer "ball" as water, for rays
  tureen convert table.glb guitar.ply -o room.glb --place guitar=at:0,0,1.2/scale:0.5
                                              one layer on the other, scaled down
  tureen convert soup.glb turned.ply --rotate 90,0,0 --resize 0.01
                                              the whole scene rotated, and in metres
  tureen convert soup.glb view.glb --view 12  programs show camera 12 first
  tureen convert soup.glb soup.html           a page to share
  tureen convert foreign.glb soup.glb --vertex-colors srgb --up 0,0,1
  tureen convert lying.ply upright.ply --up 0,1,0
                                              turned: y becomes the axis that readers assume)");
  command
      .add_option("IN", options->first,
                  "scene: a file or a folder; its content determines the format")
      .required();
  command.add_option("OUT", options->second, "file or folder to write; with -o, a second scene");
  command.add_option("FURTHER", options->further, "with -o: further scenes");
  command.add_option("-o,--output OUT", options->output, "file or folder to write, instead of OUT");
  command.add_option("--layer NAME", options->layer, "write only this layer, at its place");
  add_reading_options(command, options->scene.choice);
  add_placing_options(command, options->scene.choice);
  add_moving_options(command, *options);
  command.add_option("--view CAMERA", options->view,
                     "store the view that programs show first: the index of a recorded camera, or "
                     "FILE[:N] as for render --camera");
  add_memory_option(command);
  command.add_flag("--no-measure", options->no_measure,
                   "do not measure the loss in images if the format rounds splats");
  command.add_option("--spz-version N", options->writing.spz_version,
                     "version of .spz: 4 (default), or 3 for programs without version 4",
                     between(3.0, 4.0));
  command.add_flag("--force", options->force, "replace OUT if it exists");
  command.add_flag("--json", options->json,
                   "print the output and the losses as JSON to standard output");
  add_edit_options(command, options->edits);
  add_quality_options(command, options->quality);
  add_material_option(command, options->materials);
  add_compressed_arguments(command, options->compressed);
  command.does([options] { return convert_scene(*options); });
}

}  // namespace tureen::cli
