#include "runtime/splats/device_splats.hpp"

#include <algorithm>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "runtime/gl/state.hpp"
#include "runtime/passes/geometry.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

namespace {

/// Columns of the textures with one texel a splat, or a colour of a splat: PROJECTED_COLUMNS.
constexpr int projected_columns = 1024;

constexpr TargetFormat projected_format = target_formats::rgba32f;

/// A number as a float constant of GLSL.
std::string constant(double value) {
  std::string text = short_decimal(value, 9);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

/// shaders/splats/splat_project_NAME.glsl, splat_NAME.vert and splat_NAME.frag.
struct Shaders {
  std::string_view name;
  /// DeviceSplats::tests_depth().
  bool test_depth = false;
  /// Samplers of the further targets of splat_project.frag, from location 1 on.
  std::vector<const char*> projected = {};
};

const Shaders& shaders_of(splatting::LayerKind kind) {
  static const Shaders all[] = {
      {"windows"},
      {"gaussians", false, {"places", "axes_of_splats"}},
      {"discs", true, {"planes_xy", "planes_w", "places"}},
      {"neural", true},
  };
  return *std::find_if(std::begin(all), std::end(all), [&](const Shaders& each) {
    return each.name == splatting::facts_of(kind).shaders;
  });
}

}  // namespace

std::size_t projected_bytes(const SplatPlan& plan) {
  return (1 + shaders_of(plan.kind).projected.size()) * std::size_t(plan.colors_per_splat) *
         projected_format.bytes;
}

std::size_t DeviceSplats::projected_rows() const {
  return (projected_texels() + projected_columns - 1) / projected_columns;
}

bool DeviceSplats::tests_depth() const { return shaders_of(kind_).test_depth; }

/// Methods that trace rays have none: REdiSplats, and Splat the Net, whose tiles are larger than
/// its splats.
bool DeviceSplats::has_published_culls() const {
  return as_published_ && (profile_.low_pass == SplatProfile::LowPass::screen || !tests_depth());
}

DeviceSplats::Constants DeviceSplats::constants() const {
  const SplatProfile::LowPass low_pass = profile_.low_pass;
  const bool dilates =
      low_pass == SplatProfile::LowPass::dilation || low_pass == SplatProfile::LowPass::mip;
  return {{"TEXEL_ROW_BITS", std::to_string(layout_.row_bits)},
          {"TEXEL_LAYER_BITS", std::to_string(layout_.layer_bits)},
          {"KERNEL_TEXELS", std::to_string(splatting::facts_of(kind_).texel_rows.size() / 4)},
          {"HARMONICS_DEGREE", std::to_string(harmonics_degree_)},
          {"COLORS_PER_SPLAT", std::to_string(colors_per_splat_)},
          {"PROJECTED_COLUMNS", std::to_string(projected_columns)},
          {"ORDER_COLUMNS", std::to_string(order_columns)},
          {"MIN_ALPHA", constant(double(profile_.min_alpha))},
          {"AS_PUBLISHED", has_published_culls() ? "1" : "0"},
          {"MIN_CENTER_DEPTH", constant(double(profile_.min_center_depth))},
          {"MAX_ALPHA", constant(double(profile_.max_alpha))},
          {"DILATION", dilates ? "1" : "0"},
          {"DILATION_VARIANCE", constant(dilation_variance)},
          {"SCREEN_FILTER", low_pass == SplatProfile::LowPass::screen ? "1" : "0"},
          {"SCREEN_VARIANCE", constant(screen_variance)},
          {"KEEP_INTEGRAL", low_pass == SplatProfile::LowPass::mip ? "1" : "0"}};
}

DeviceSplats::DeviceSplats(const gl::Capabilities& device, SplatSource source,
                           const SplatPlan& plan)
    : kind_(plan.kind),
      profile_(plan.profile),
      as_published_(plan.as_published),
      harmonics_degree_(plan.harmonics_degree),
      colors_per_splat_(plan.colors_per_splat),
      largest_color_(plan.largest_color),
      may_skip_hidden_(plan.applies(Specialisation::hidden_splats)),
      centers_(std::move(source.centers)),
      chunks_(plan.chunks),
      layout_(source.layout),
      kernel_(source.layout, source.kernel),
      coefficients_(source.layout, source.coefficients),
      device_(device) {
  if (!device.float_targets)
    throw DeviceLimitError(
        "splats need textures of floats as targets (EXT_color_buffer_float), which this device "
        "lacks");
  const Shaders& shaders = shaders_of(kind_);
  projection_ = full_screen_program(
      {.file = "splat_project.frag",
       .constants = constants(),
       .generated = {{"splat_project_kernel.glsl",
                      "#include \"splat_project_" + std::string(shaders.name) + ".glsl\"\n"}}},
      device.api);
  drawings_[std::size_t(SplatOutput::color)] = make_program(SplatOutput::color);
  const auto rows = static_cast<int>(projected_rows());
  if (rows > device.max_texture_size)
    throw DeviceLimitError(
        "the layer has " + std::to_string(centers_.size()) + " splats; this device draws at most " +
            std::to_string(std::size_t(device.max_texture_size) * std::size_t(projected_columns) /
                           std::size_t(colors_per_splat_)),
        "read fewer splats: --max-splats N");
  for (std::size_t i = 0; i < 1 + shaders.projected.size(); ++i)
    projected_.push_back(make_target(projected_format, projected_columns, std::max(rows, 1)));
  gl::check("DeviceSplats");
}

gl::Program DeviceSplats::make_program(SplatOutput output) const {
  const Shaders& shaders = shaders_of(kind_);
  Constants with_output = constants();
  constexpr const char* names[splat_outputs] = {"OUTPUT_COLOR",    "OUTPUT_SUMS",
                                                "OUTPUT_PREFIXES", "OUTPUT_DEPTH_FOUND",
                                                "OUTPUT_SAMPLE",   "OUTPUT_COUNTS"};
  for (std::size_t i = 0; i < splat_outputs; ++i) with_output[names[i]] = std::to_string(i);
  with_output["OUTPUT"] = std::to_string(std::size_t(output));
  with_output["MEASURES"] =
      output == SplatOutput::color || output == SplatOutput::sample ? "0" : "1";
  with_output["HIDDEN_TILE_SIDE"] = std::to_string(HiddenTiles::side);
  with_output["HIDDEN_LEVELS"] = std::to_string(HiddenTiles::levels);
  const auto stage = [&](const char* extension) {
    const std::string file = "splat_" + std::string(shaders.name) + extension;
    return assemble({.file = file, .constants = with_output}, device_.api);
  };
  return gl::Program(stage(".vert"), stage(".frag"));
}

void DeviceSplats::project(const Frame& frame, float color_unit) {
  if (centers_.empty()) return;
  if (!projected_framebuffer_) {
    std::vector<GLuint> targets;
    for (const gl::Texture& texture : projected_) targets.push_back(texture.id());
    projected_framebuffer_ = make_framebuffer(targets);
  }
  gl::use_plain_rasterisation(projected_columns, static_cast<int>(projected_rows()));
  glDisable(GL_DEPTH_TEST);
  glBindFramebuffer(GL_FRAMEBUFFER, projected_framebuffer_.id());
  projection_.use();
  projection_.set_texture("kernel", 0, kernel_.texture(), GL_TEXTURE_2D_ARRAY);
  projection_.set_texture("coefficients", 1, coefficients_.texture(), GL_TEXTURE_2D_ARRAY);
  projection_.set("projected_count", static_cast<int>(projected_texels()));
  projection_.set("color_unit", color_unit);
  set_view(projection_, frame);
  full_screen_.draw(projection_);
}

/// Uniforms of the camera, for both programs; each ignores those that it does not use.
void DeviceSplats::set_view(const gl::Program& program, const Frame& frame) const {
  const FrameCamera& in_layer = frame.layers[layer_];
  const Camera& camera = in_layer.camera;
  set_eye(program, in_layer.eye);
  program.set("view_from_layer", glm::mat3(glm::dmat3(camera.view_from_world)));
  program.set("focal", glm::vec2(camera.fx, camera.fy));
  program.set("principal_point", glm::vec2(camera.cx, camera.height - camera.cy));
  const Camera whole = frame.input.whole.value_or(camera);
  program.set("slope_range", ewa_slope_range(whole));
  const glm::vec2 corner(whole.cx - camera.cx, whole.cy - camera.cy + camera.height);
  program.set("whole_corner", corner);
  program.set("sample_corner", corner + glm::vec2(frame.first_sample));
  program.set("near", static_cast<float>(in_layer.range.near));
  program.set("pixel_area", static_cast<float>(frame.samples_per_pixel * frame.samples_per_pixel));
  program.set("half_size", 0.5f * glm::vec2(camera.width, camera.height));
}

void DeviceSplats::begin_runs(const Frame& frame, const FrameTarget& target, GLuint order,
                              const SplatDrawing& drawing) {
  const FrameCamera& in_layer = frame.layers[layer_];
  std::optional<gl::Program>& made = drawings_[std::size_t(drawing.output)];
  if (!made) made = make_program(drawing.output);
  const gl::Program& program = *made;
  program.use();
  program.set_texture("order", 0, order);
  program.set_texture("kernel", 1, kernel_.texture(), GL_TEXTURE_2D_ARRAY);
  program.set_texture("colors", 2, projected_[0].id());
  int unit = 3;
  for (const char* name : shaders_of(kind_).projected) {
    program.set_texture(name, unit, projected_[std::size_t(unit - 2)].id());
    ++unit;
  }
  if (tests_depth() || drawing.output == SplatOutput::sample)
    program.set_texture("depth_texture", unit++, target.depth_texture());
  if (drawing.bounds) program.set_texture("bounds", unit++, drawing.bounds);
  program.set("skips_hidden", drawing.hidden ? 1 : 0);
  // Also without tiles: samplers of different types may not share a unit.
  program.set_texture("hidden", unit, drawing.hidden ? drawing.hidden->texture() : 0);
  set_view(program, frame);
  set_rays(program, in_layer.camera);
  const glm::dmat4 clip_from_view = target.clip_from_view(in_layer.camera, in_layer.range);
  const glm::dmat4 rotation(glm::dmat3(in_layer.camera.view_from_world));
  program.set("clip_from_camera", glm::mat4(clip_from_view * rotation));
  program.set("depth_of_z", glm::vec2(clip_from_view[2][2], clip_from_view[3][2]));
  program.set("ndc_from_stored",
              target.reversed_depth() ? glm::vec2(1.0f, 0.0f) : glm::vec2(2.0f, -1.0f));
  program.set("far_stored", target.far_depth());
  program.set("nearest", static_cast<float>(in_layer.range.near));
  program.set("layer", static_cast<int>(layer_));
  if (drawing.output != SplatOutput::color) {
    program.set("world_scale", static_cast<float>(in_layer.scale));
    program.set("world_from_layer", glm::mat3(in_layer.world_from_layer));
  }
  nothing_.bind();
}

void DeviceSplats::draw_run(std::uint32_t first, std::uint32_t count) {
  glDrawArrays(GL_TRIANGLES, static_cast<GLint>(3 * first), static_cast<GLsizei>(3 * count));
}

std::size_t DeviceSplats::device_bytes() const {
  return kernel_.device_bytes() + coefficients_.device_bytes() +
         projected_.size() * projected_rows() * projected_columns * projected_format.bytes;
}

void DeviceSplats::leave_context() {
  full_screen_.leave_context();
  nothing_.forget();
  projected_framebuffer_ = {};
}

glm::vec4 ewa_slope_range(const Camera& camera) {
  const glm::dvec2 margin = ewa_margin * glm::dvec2(camera.width, camera.height);
  const glm::dvec2 focal(camera.fx, camera.fy);
  const glm::dvec2 low(-camera.cx, camera.cy - camera.height),
      high(camera.width - camera.cx, camera.cy);
  return glm::vec4((low - margin) / focal, (high + margin) / focal);
}

}  // namespace tureen
