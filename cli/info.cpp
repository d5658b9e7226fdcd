// `tureen info`: a scene's contents, memory use and lint findings.
#include <fmt/format.h>

#include <map>
#include <memory>

#include "base/decimal_text.hpp"
#include "camera/navigation.hpp"
#include "cli/commands.hpp"
#include "cli/options/memory_option.hpp"
#include "cli/options/scene_argument.hpp"
#include "cli/report.hpp"
#include "cli/table.hpp"
#include "formats/dataset/camera_file.hpp"
#include "jobs/results/plan_json.hpp"
#include "runtime/device_forecast.hpp"
#include "runtime/plan/plan_description.hpp"
#include "scene/edit/lint.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen::cli {

namespace {

struct InfoOptions {
  SceneArgument scene;
  bool strict = false;
  bool json = false;
};

Json to_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

std::string vector_text(const glm::dvec3& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

const char* name(DirectionEncoding encoding) {
  switch (encoding) {
    case DirectionEncoding::none:
      return "none";
    case DirectionEncoding::xyz:
      return "xyz";
    case DirectionEncoding::harmonics2:
      return "harmonics2";
  }
  return "";
}

const char* name(ViewConvention view) {
  return view == ViewConvention::surface_to_eye ? "surface_to_eye" : "eye_to_surface";
}

Json mlp_json(const ColorMlp& mlp) {
  Json widths = {mlp.layers.front().inputs};
  for (const DenseLayer& layer : mlp.layers) widths.push_back(layer.outputs);
  return {{"layers", widths},
          {"direction_encoding", name(mlp.encoding)},
          {"view_direction", name(mlp.view)},
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
    json["view_direction"] = name(sh.view);
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

Json to_json(const Lint& lint) {
  Json json = {{"clean", lint.findings.empty()}};
  for (const LintFinding::Id id : LintFinding::counted) {
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
const std::vector<NamedDevice>& named_devices() {
  static const std::vector<NamedDevice> devices{
      {"minimum of OpenGL ES 3.0 and WebGL 2", {2048, 256, false}},
      {"older phones", {4096, 512, false}},
      {"phones, browsers without a GPU", {8192, 2048, false}},
      {"desktop GPUs, llvmpipe", {16384, 2048, true}},
  };
  return devices;
}

ExitCode inform(const InfoOptions& options) {
  Scene scene = read(options.scene);
  const Layer& layer = only_layer(scene);
  const bool soft = std::holds_alternative<SoftTriangles>(layer.primitives);
  make_opaque(scene);
  const TriangleSoup& soup = only_soup(scene);
  const Subject subject = subject_of(scene);
  const std::uint64_t on_disk = bytes_on_disk(options.scene.path);
  const RenderPlan plan = make_plan(soup, named_devices().back().limits);
  const DeviceForecast forecast = device_forecast(soup, plan.layers.front());
  const Lint findings = lint(soup);
  Described appearance;
  std::visit(appearance, soup.appearance);

  Json devices = Json::array();
  std::vector<std::string> device_lines;
  bool fits_everywhere = true;
  for (const NamedDevice& device : named_devices()) {
    const std::uint64_t capacity = texel_capacity(device.limits);
    const bool fits = forecast.largest_store_texels <= capacity;
    fits_everywhere = fits_everywhere && fits;
    devices.push_back({{"name", device.name},
                       {"max_texture_size", device.limits.max_texture_size},
                       {"max_array_layers", device.limits.max_array_layers},
                       {"fits", fits}});
    device_lines.push_back(
        fmt::format("{} ({} x {}, {} layers): {}", device.name, device.limits.max_texture_size,
                    device.limits.max_texture_size, device.limits.max_array_layers,
                    fits ? "fits"
                         : fmt::format("does not fit: {} has {} texels, but a texture holds at "
                                       "most {}",
                                       forecast.largest_store,
                                       counted(forecast.largest_store_texels), counted(capacity))));
  }

  Table table({"", "<"});
  if (!scene.info.name.empty()) table.row({"name", scene.info.name});
  table.row({"triangles", fmt::format("{} with {} vertices{}", counted(soup.triangles.size()),
                                      counted(soup.positions.size()),
                                      soft ? ", soft triangles, drawn as opaque" : "")});
  table.row({"appearance", appearance_name(soup.appearance)});
  for (const std::string& line : appearance.lines) table.row({"", line});
  table.row({"bytes", fmt::format("{} on disk, {} in memory, {} on the device", bytes_text(on_disk),
                                  bytes_text(byte_size(soup)), bytes_text(forecast.bytes))});
  table.row({"bounds", vector_text(subject.low) + " to " + vector_text(subject.high)});
  table.row({"up", vector_text(scene.info.up)});
  table.row({"cameras", std::to_string(scene.cameras.size())});
  if (scene.quality != Quality{}) table.row({"quality", describe(scene.quality)});
  say_list(fmt::format("{}: {}", options.scene.path,
                       scene.info.source.empty() ? "a scene" : scene.info.source),
           table.lines());
  say_list("Notes:", all_notes(scene.info));
  say_list("Plan:", describe(plan));
  say_list("Devices:", device_lines);
  std::vector<std::string> lint_lines;
  for (const LintFinding& finding : findings.findings) lint_lines.push_back(describe(finding));
  if (lint_lines.empty()) lint_lines.emplace_back("nothing found");
  say_list("Lint:", lint_lines);

  if (options.json) {
    Json json = {{"file", options.scene.path},
                 {"name", scene.info.name},
                 {"source", scene.info.source},
                 {"triangles", soup.triangles.size()},
                 {"vertices", soup.positions.size()},
                 {"soft_triangles", soft},
                 {"appearance", appearance_name(soup.appearance)}};
    json.update(appearance.json);
    json.update({{"bytes_on_disk", on_disk},
                 {"bytes_in_memory", byte_size(soup)},
                 {"bytes_on_device", forecast.bytes},
                 {"bounds", {{"low", to_json(subject.low)}, {"high", to_json(subject.high)}}},
                 {"origin", to_json(origin_of(layer))},
                 {"up", to_json(glm::dvec3(scene.info.up))},
                 {"background", to_json(glm::dvec3(scene.info.background))},
                 {"cameras", Json::parse(cameras_to_json(scene.cameras)).at("cameras")},
                 {"notes", all_notes(scene.info)},
                 {"remarks", remarks_json(scene.info.remarks)},
                 {"preset", scene.quality != Quality{} ? Json(describe(scene.quality)) : Json()},
                 {"quality",
                  {{"resolution_scale", scene.quality.resolution_scale},
                   {"supersampling", scene.quality.supersampling}}},
                 {"plan", describe(plan)},
                 {"specialisations", results::specialisations_json(plan.applied())},
                 {"devices", devices},
                 {"lint", to_json(findings)}});
    print_json(json);
  }
  const bool clean = findings.findings.empty() && fits_everywhere;
  return options.strict && !clean ? ExitCode::check_failed : ExitCode::done;
}

}  // namespace

void add_info(Command& program) {
  auto options = std::make_shared<InfoOptions>();
  Command command =
      program.add_command("info", "Print a scene's contents, memory use and lint findings");
  command.footer(
      R"(Lint reports non-finite vertices, faces without area, repeated faces, fully transparent
faces, unused vertices, and coordinates so large that floats round them visibly. Scenes with
findings can still be drawn. render --camera can read the cameras from the JSON of --json.

Examples:
  tureen info soup.glb
  tureen info soup.glb --json | jq .triangles
  tureen info soup.glb --strict               a check for scripts)");
  add_scene_argument(command, options->scene);
  add_memory_option(command);
  command.add_flag("--json", options->json, "print all properties as JSON to standard output");
  command.add_flag("--strict", options->strict,
                   "exit with 1 if lint finds anything or the scene fits only on some devices");
  command.does([options] { return inform(*options); });
}

}  // namespace tureen::cli
