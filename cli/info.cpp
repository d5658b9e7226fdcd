// `tureen info`: a scene's contents, memory use and lint findings. Of a dataset: dataset_info.hpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>

#include "base/decimal_text.hpp"
#include "base/existing_path.hpp"
#include "base/platform/process.hpp"
#include "base/shown_text.hpp"
#include "camera/navigation.hpp"
#include "camera/survey_views.hpp"
#include "cli/commands.hpp"
#include "cli/dataset_info.hpp"
#include "cli/options/memory_option.hpp"
#include "cli/options/scene_argument.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/table.hpp"
#include "formats/dataset/camera_file.hpp"
#include "formats/dataset/dataset.hpp"
#include "jobs/bench/plan_json.hpp"
#include "jobs/cameras/camera_run.hpp"
#include "jobs/visibility/splat_stats.hpp"
#include "runtime/device_forecast.hpp"
#include "runtime/plan/plan_description.hpp"
#include "scene/edit/baked_transform.hpp"
#include "scene/lint/lint.hpp"
#include "scene/similarity.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen::cli {

namespace {

struct InfoOptions {
  SceneArguments scene;
  bool strict = false;
  bool json = false;
  bool stats = false;
  std::string plot;  // of a dataset
};

Json to_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json mlp_json(const ColorMlp& mlp) {
  Json widths = {mlp.layers.front().inputs};
  for (const DenseLayer& layer : mlp.layers) widths.push_back(layer.outputs);
  return {{"layers", widths},
          {"direction_encoding", direction_encodings[std::size_t(mlp.encoding)]},
          {"view_direction", view_conventions[std::size_t(mlp.view)]},
          {"blend_channel", mlp.blend_channel ? Json(*mlp.blend_channel) : Json(nullptr)}};
}

/// "16-16-16-3".
std::string mlp_text(const ColorMlp& mlp) {
  std::string text = std::to_string(mlp.layers.front().inputs);
  for (const DenseLayer& layer : mlp.layers) text += "-" + std::to_string(layer.outputs);
  return text;
}

/// The appearance as JSON and as text.
struct Described {
  Json json = Json::object();
  std::vector<std::string> lines;

  void operator()(const FaceColors&) {}
  void operator()(const VertexColors&) {}
  void operator()(const Harmonics& sh) {
    json["degree"] = sh.degree;
    json["view_direction"] = view_conventions[std::size_t(sh.view)];
    lines.push_back(fmt::format("harmonics of degree {}, {} coefficients", sh.degree,
                                harmonics::count(sh.degree)));
  }
  void operator()(const LatticeTexture& texture) {
    std::map<std::uint32_t, std::size_t> faces_of_level;
    for (const LatticePatch& patch : texture.patches) ++faces_of_level[patch.level];
    json["levels"] = Json::array();
    std::string text;
    for (const auto& [level, faces] : faces_of_level) {
      json["levels"].push_back({{"level", level}, {"triangles", faces}});
      text +=
          fmt::format("{}level {}: {} triangles", text.empty() ? "" : ", ", level, counted(faces));
    }
    json["texels"] = texture.texel_count();
    json["texel_bits"] = texture.is_float() ? 32 : 8;
    lines.push_back(text);
    lines.push_back(fmt::format("{} texels of {} bits a channel", counted(texture.texel_count()),
                                texture.is_float() ? 32 : 8));
    describe(texture.mlp);
  }
  void operator()(const UvTextures& textures) {
    json["materials"] = textures.materials.size();
    json["images"] = Json::array();
    for (const Image8& image : textures.images) {
      json["images"].push_back({{"width", image.width}, {"height", image.height}});
      lines.push_back(fmt::format("image of {} x {}", image.width, image.height));
    }
    describe(textures.mlp);
  }

 private:
  void describe(const std::optional<ColorMlp>& mlp) {
    if (!mlp) return;
    json["color_mlp"] = mlp_json(*mlp);
    lines.push_back("color MLP " + mlp_text(*mlp));
  }
};

Json to_json(const Lint& lint, std::span<const LintFinding::Id> ids) {
  Json json = {{"clean", lint.findings.empty()}};
  for (const LintFinding::Id id : ids) {
    const LintFinding* found = lint.find(id);
    json[name_of(id)] = {{"count", found ? found->count : 0},
                         {"first", found ? found->first : std::vector<std::uint32_t>()}};
  }
  json["extent_over_offset"] = lint.extent_over_offset;
  json["findings"] = Json::array();
  json["sentences"] = Json::array();
  for (const LintFinding& finding : lint.findings) {
    json["findings"].push_back(name_of(finding.id));
    json["sentences"].push_back(describe(finding));
  }
  return json;
}

struct NamedDevice {
  const char* name;
  DeviceLimits limits;
};

/// GL_MAX_TEXTURE_SIZE and GL_MAX_ARRAY_TEXTURE_LAYERS of common devices.
constexpr std::array named_devices{
    NamedDevice{"minimum of OpenGL ES 3.0 and WebGL 2", {2048, 256, false}},
    NamedDevice{"older phones", {4096, 512, false}},
    NamedDevice{"phones, browsers without a GPU", {8192, 2048, false}},
    NamedDevice{"desktop GPUs, llvmpipe", {16384, 2048, true}}};

/// The printed facts of one layer.
struct LayerFacts {
  std::string name;  // label() of the layer
  const Layer* layer;
  const TriangleSoup* soup;  // null for splats
  const Splats* splats;      // null for a soup
  Described appearance;      // of a soup
  RenderPlan plan;
  DeviceForecast forecast;
  Lint lint;
  std::optional<SplatStats> stats = {};  // of splats, on request
};

/// As many views as `tureen convert` compares; sizes that take seconds for 100,000 splats.
constexpr std::size_t stats_views = 16;
constexpr int stats_side = 400;

void add_stats(const Scene& scene, std::vector<LayerFacts>& layers) {
  const std::vector<Camera> views = survey_views(scene, stats_views, stats_side);
  Progress progress("drawing views");
  for (LayerFacts& facts : layers)
    if (facts.splats)
      facts.stats = splat_stats(*facts.splats, facts.layer->world_from_layer, views,
                                [&](double done) { progress.update(done); });
}

std::vector<std::string> stats_lines(const SplatStats& stats, const Splats& splats) {
  std::vector<std::string> lines;
  if (stats.views > 0) {
    lines.push_back(fmt::format(
        "overdraw: {:.1f} splats per covered pixel over {} views, at most {:.1f}{}",
        stats.mean_overdraw, stats.views, stats.worst_overdraw,
        stats.worst_view.empty() ? "" : fmt::format(" ({})", shown_text(stats.worst_view))));
    lines.push_back(fmt::format("never drawn in these views: {} ({:.1f} %)",
                                counted(stats.never_drawn, "splat"),
                                100.0 * double(stats.never_drawn) / double(count(splats))));
  } else {
    lines.push_back("overdraw: not measured, as there are too many splats");
  }
  for (const ColumnBytes& column : stats.columns)
    lines.push_back(column.name + ": " + bytes_text(column.bytes));
  return lines;
}

Json stats_json(const SplatStats& stats) {
  Json bytes = Json::object();
  for (const ColumnBytes& column : stats.columns) bytes[column.name] = column.bytes;
  return {{"views", stats.views},
          {"mean_overdraw", stats.mean_overdraw},
          {"worst_overdraw", stats.worst_overdraw},
          {"worst_view", stats.worst_view},
          {"never_drawn", stats.never_drawn},
          {"bytes", bytes}};
}

Json lint_json(const LayerFacts& facts) {
  return facts.soup ? to_json(facts.lint, LintFinding::counted)
                    : to_json(facts.lint, LintFinding::counted_of_splats);
}

LayerFacts facts_of(const Scene& scene, std::size_t index) {
  const Layer& layer = scene.layers[index];
  const bool several = scene.layers.size() > 1;
  LayerFacts facts{.name = label(layer, index),
                   .layer = &layer,
                   .soup = std::get_if<TriangleSoup>(&layer.primitives),
                   .splats = std::get_if<Splats>(&layer.primitives),
                   .appearance = {},
                   .plan = {},
                   .forecast = {},
                   .lint = {}};
  if (facts.splats) {
    SplatPlan plan = make_splat_plan(*facts.splats);
    facts.forecast = device_forecast(*facts.splats, plan);
    facts.lint = lint(*facts.splats);
    facts.plan.add(std::move(plan));
    return facts;
  }
  const TriangleSoup& soup = *facts.soup;
  facts.plan = make_plan(soup, named_devices.back().limits);
  facts.lint = lint(soup);
  // Several layers are all drawn deferred.
  if (several) make_layered(facts.plan.soup(0));
  facts.forecast = device_forecast(soup, facts.plan.soup(0));
  std::visit(facts.appearance, soup.appearance);
  return facts;
}

std::string place_text(const Layer& layer) {
  return describe(similarity_of(layer.world_from_layer)) + (layer.visible ? "" : "; hidden");
}

std::string surface_text(const Material& material) {
  if (is_mirror(material)) return "mirror";
  if (is_glass(material)) return fmt::format("glass, index of refraction {:g}", material.ior);
  return "its appearance: the material is neither a mirror nor glass";
}

void add_appearance(Table& table, const LayerFacts& facts) {
  if (facts.splats) return;
  table.row({"appearance", appearance_name(facts.soup->appearance)});
  for (const std::string& line : facts.appearance.lines) table.row({"", line});
  if (facts.layer->material) table.row({"for rays", surface_text(*facts.layer->material)});
}

std::string triangles_text(std::size_t triangles, std::size_t vertices) {
  return fmt::format("{} with {} vertices", counted(triangles), counted(vertices));
}

std::vector<std::string> lint_lines(const Lint& lint) {
  std::vector<std::string> lines;
  for (const LintFinding& finding : lint.findings) lines.push_back(describe(finding));
  if (lines.empty()) lines.emplace_back("nothing found");
  return lines;
}

/// One of several layers: contents, place, plan and lint findings.
void say_layer(const LayerFacts& facts) {
  Table table({"", "<"});
  if (facts.splats)
    table.row({"splats", describe(*facts.splats)});
  else
    table.row(
        {"triangles", triangles_text(facts.soup->triangles.size(), facts.soup->positions.size())});
  add_appearance(table, facts);
  table.row({"place", place_text(*facts.layer)});
  say_list("Layer " + facts.name + ":", table.lines());
  say_list("Plan of " + facts.name + ":", describe(facts.plan));
  say_list("Lint of " + facts.name + ":", lint_lines(facts.lint));
  if (facts.stats)
    say_list("Statistics of " + facts.name + ":", stats_lines(*facts.stats, *facts.splats));
}

Json matrix_json(const glm::dmat4& matrix) {
  Json json = Json::array();
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) json.push_back(matrix[column][row]);
  return json;
}

/// The keys that a scene of one layer has at its top level.
Json contents_json(const LayerFacts& facts) {
  if (const Splats* splats = facts.splats)
    return {{"splats", count(*splats)},
            {"kernel", kernel_name(splats->kernel)},
            {"profile", profile_name(*splats)},
            {"degree", splats->color.degree},
            {"per_corner", splats->color.per_corner},
            {"soft_triangles", std::holds_alternative<TriangleWindows>(splats->kernel)}};
  Json json = {{"triangles", facts.soup->triangles.size()},
               {"vertices", facts.soup->positions.size()},
               {"soft_triangles", false},
               {"appearance", appearance_name(facts.soup->appearance)}};
  json.update(facts.appearance.json);
  if (const auto& material = facts.layer->material)
    json["material"] = {{"base_color", to_json(glm::dvec3(material->base_color))},
                        {"metallic", material->metallic},
                        {"roughness", material->roughness},
                        {"transmission", material->transmission},
                        {"ior", material->ior}};
  return json;
}

Json plan_json(const RenderPlan& plan) {
  return {{"plan", describe(plan)},
          {"specialisations", results::specialisations_json(plan.applied())}};
}

std::size_t bytes_in_memory(const LayerFacts& facts) {
  return facts.splats ? byte_size(*facts.splats) : byte_size(*facts.soup);
}

Json to_json(const LayerFacts& facts) {
  Json json = {{"name", facts.layer->name},
               {"visible", facts.layer->visible},
               {"world_from_layer", matrix_json(facts.layer->world_from_layer)}};
  json.update(contents_json(facts));
  json.update(
      {{"bytes_in_memory", bytes_in_memory(facts)}, {"bytes_on_device", facts.forecast.bytes}});
  json.update(plan_json(facts.plan));
  json["lint"] = lint_json(facts);
  if (facts.stats) json["stats"] = stats_json(*facts.stats);
  return json;
}

/// Sums over all layers.
struct Totals {
  std::size_t triangles = 0, vertices = 0, splats = 0;
  std::uint64_t bytes_in_memory = 0, bytes_on_device = 0;

  explicit Totals(const std::vector<LayerFacts>& layers) {
    for (const LayerFacts& facts : layers) {
      triangles += facts.soup ? facts.soup->triangles.size() : 0;
      vertices += facts.soup ? facts.soup->positions.size() : 0;
      splats += facts.splats ? count(*facts.splats) : 0;
      bytes_in_memory += cli::bytes_in_memory(facts);
      bytes_on_device += facts.forecast.bytes;
    }
  }
};

/// Whether the scene fits on common devices. Each layer has stores of its own.
struct DeviceFit {
  Json json = Json::array();
  std::vector<std::string> lines;
  bool everywhere = true;

  explicit DeviceFit(const std::vector<LayerFacts>& layers) {
    const DeviceForecast& largest =
        std::max_element(layers.begin(), layers.end(), [](const auto& a, const auto& b) {
          return a.forecast.largest_store_texels < b.forecast.largest_store_texels;
        })->forecast;
    for (const NamedDevice& device : named_devices) {
      const std::uint64_t capacity = texel_capacity(device.limits);
      const bool fits = largest.largest_store_texels <= capacity;
      everywhere = everywhere && fits;
      json.push_back({{"name", device.name},
                      {"max_texture_size", device.limits.max_texture_size},
                      {"max_array_layers", device.limits.max_array_layers},
                      {"fits", fits}});
      lines.push_back(fmt::format(
          "{} ({} x {}, {} layers): {}", device.name, device.limits.max_texture_size,
          device.limits.max_texture_size, device.limits.max_array_layers,
          fits ? "fits"
               : fmt::format("does not fit: {} has {} texels, but a texture holds at most {}",
                             largest.largest_store, counted(largest.largest_store_texels),
                             counted(capacity))));
    }
  }
};

void say_scene(const InfoOptions& options, const Scene& scene, const Subject& subject,
               const std::vector<LayerFacts>& layers, const DeviceFit& devices) {
  const LayerFacts* only = layers.size() == 1 ? &layers.front() : nullptr;
  const Totals totals(layers);
  Table table({"", "<"});
  if (!scene.info.name.empty()) table.row({"name", scene.info.name});
  if (!only) table.row({"layers", std::to_string(layers.size())});
  if (totals.splats == 0 || totals.triangles > 0)
    table.row({"triangles", triangles_text(totals.triangles, totals.vertices)});
  if (totals.splats > 0)
    table.row({"splats", only ? describe(*only->splats) : counted(totals.splats)});
  if (only) add_appearance(table, *only);
  table.row({"bytes",
             fmt::format("{} on disk, {} in memory, {} on the device",
                         bytes_text(bytes_on_disk(options.scene)),
                         bytes_text(totals.bytes_in_memory), bytes_text(totals.bytes_on_device))});
  table.row({"bounds", vector_text(subject.low) + " to " + vector_text(subject.high)});
  if (only && (!is_translation(*only->layer) || !only->layer->visible))
    table.row({"place", place_text(*only->layer)});
  table.row({"up", vector_text(scene.info.up)});
  table.row({"cameras", std::to_string(scene.cameras.size()) +
                            (scene.first_view ? ", and a first view" : "")});
  if (scene.quality != Quality{}) table.row({"quality", describe(scene.quality)});
  say_list(fmt::format("{}: {}", listed(options.scene),
                       scene.info.source.empty() ? "a scene" : scene.info.source),
           table.lines());
  say_what_is_hidden(scene);
  say_list("Notes:", notes_of(scene.info));
  if (only) say_list("Plan:", describe(only->plan));
  say_list("Devices:", devices.lines);
  if (only) say_list("Lint:", lint_lines(only->lint));
  if (only && only->stats) say_list("Statistics:", stats_lines(*only->stats, *only->splats));
  if (!only)
    for (const LayerFacts& facts : layers) say_layer(facts);
}

/// With one layer, its properties are at the top level; with several, in "layers".
Json to_json(const InfoOptions& options, const Scene& scene, const Subject& subject,
             const std::vector<LayerFacts>& layers, const DeviceFit& devices) {
  const LayerFacts* only = layers.size() == 1 ? &layers.front() : nullptr;
  const Totals totals(layers);
  Json json = Json::object();
  if (options.scene.paths.size() == 1)
    json["file"] = options.scene.paths.front();
  else
    json["files"] = options.scene.paths;
  json.update({{"name", scene.info.name}, {"source", scene.info.source}});
  if (only) {
    json.update(contents_json(*only));
  } else {
    json.update({{"triangles", totals.triangles},
                 {"vertices", totals.vertices},
                 {"splats", totals.splats}});
    json["layers"] = Json::array();
    for (const LayerFacts& facts : layers) json["layers"].push_back(to_json(facts));
  }
  json.update({{"bytes_on_disk", bytes_on_disk(options.scene)},
               {"bytes_in_memory", totals.bytes_in_memory},
               {"bytes_on_device", totals.bytes_on_device},
               {"bounds", {{"low", to_json(subject.low)}, {"high", to_json(subject.high)}}}});
  if (only) json["origin"] = to_json(origin_of(*only->layer));
  if (only && !is_translation(*only->layer))
    json["world_from_layer"] = matrix_json(only->layer->world_from_layer);
  json.update({{"up", to_json(glm::dvec3(scene.info.up))},
               {"background", to_json(glm::dvec3(scene.info.background))},
               {"cameras", Json::parse(cameras_to_json(scene.cameras)).at("cameras")},
               {"notes", notes_of(scene.info)},
               {"remarks", remarks_json(scene.info.remarks)},
               {"preset", scene.quality != Quality{} ? Json(describe(scene.quality)) : Json()},
               {"quality",
                {{"resolution_scale", scene.quality.resolution_scale},
                 {"supersampling", scene.quality.supersampling},
                 {"splat_order", name_of(scene.quality.splat_order)}}}});
  if (only) json.update(plan_json(only->plan));
  json["devices"] = devices.json;
  if (only) json["lint"] = lint_json(*only);
  if (only && only->stats) json["stats"] = stats_json(*only->stats);
  return json;
}

/// Whether the arguments name a dataset. Throws UsageError for options that only the other kind
/// has, and for several paths with a dataset among them.
bool of_dataset(const InfoOptions& options) {
  const std::vector<std::string>& paths = options.scene.paths;
  const auto dataset = std::find_if(paths.begin(), paths.end(), [](const std::string& path) {
    return is_dataset(path) && !is_scene(path);
  });
  for (const std::string& path : paths)
    if (is_photographs(path) && !is_scene(path)) {
      const auto around = dataset_around(path);
      throw InputError({path}, "photographs or a video, without cameras",
                       (around ? "tureen info " + shell_word(around->string()) +
                                     " prints the dataset around them; "
                               : "") +
                           "tureen cameras " + shell_word(path) + " finds the cameras");
    }
  if (dataset == paths.end()) {
    if (options.plot.empty()) return false;
    for (const std::string& path : paths) require_there(path);
    throw UsageError("-o writes a plot of a dataset, not of a scene");
  }
  if (paths.size() > 1)
    throw UsageError("'" + *dataset + "' is a dataset; info prints only one at a time");
  if (options.strict || options.stats || options.scene.choice != ReadingChoice{})
    throw UsageError("'" + *dataset +
                     "' is a dataset: of the options, only --json, -o and --max-memory apply");
  return true;
}

ExitCode inform(const InfoOptions& options) {
  if (of_dataset(options)) {
    inform_of_dataset({.path = options.scene.paths[0], .plot = options.plot, .json = options.json});
    return ExitCode::done;
  }
  SceneArguments arguments = options.scene;
  arguments.choice.keep_rows = true;  // lint names rows of the file
  const Scene scene = read(arguments);
  std::vector<LayerFacts> layers;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) layers.push_back(facts_of(scene, i));
  if (options.stats) add_stats(scene, layers);
  const Subject subject = subject_of(boxes_of(scene), glm::dvec3(scene.info.up));
  const DeviceFit devices(layers);
  say_scene(options, scene, subject, layers, devices);
  if (options.json) print_json(to_json(options, scene, subject, layers, devices));
  const bool clean =
      devices.everywhere && std::all_of(layers.begin(), layers.end(), [](const LayerFacts& facts) {
        return facts.lint.findings.empty();
      });
  return options.strict && !clean ? ExitCode::check_failed : ExitCode::done;
}

}  // namespace

void add_info(Command& program) {
  auto options = std::make_shared<InfoOptions>();
  Command command = program.add_command("info", "Print the contents of a scene, or of a dataset");
  command.footer(
      R"(Lint reports non-finite vertices, faces without area, repeated faces, fully transparent
faces, unused vertices, and coordinates so large that floats round them visibly. It also
reports transparent, collapsed, needle-shaped, outlying and repeated splats, and harmonics
that are 0. Scenes with findings can still be drawn. Plan and lint are printed for each layer.
A dataset is a folder of photographs with known cameras, as for tureen train.
The output of --json contains the cameras; tureen render --camera can read them from it.

Examples:
  tureen info soup.glb
  tureen info house.glb fox.glb               the layers of a scene from two files
  tureen info soup.glb --json | jq .triangles
  tureen info splats.ply --stats              splats per pixel, unseen splats, bytes
  tureen info soup.glb --strict               a check for scripts
  tureen info photographs -o cameras.svg      a dataset: sizes, lenses, points, plot of cameras)");
  add_scene_arguments(command, options->scene);
  command.add_option("-o,--output PLOT.svg", options->plot,
                     "for a dataset: plot of its cameras from above and from the side");
  add_memory_option(command);
  command.add_flag("--json", options->json, "print all properties as JSON to standard output");
  command.add_flag("--stats", options->stats,
                   "for splats: draw 16 views; print the splats blended per pixel, the splats that "
                   "no view shows, and the bytes per column");
  command.add_flag("--strict", options->strict,
                   "exit with 1 if lint finds anything or the scene fits only on some devices");
  command.does([options] { return inform(*options); });
}

}  // namespace tureen::cli
