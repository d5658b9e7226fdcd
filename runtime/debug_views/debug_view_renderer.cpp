#include "runtime/debug_views/debug_view_renderer.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "runtime/gl/state.hpp"
#include "runtime/passes/device_appearance.hpp"
#include "runtime/passes/fragment_store.hpp"
#include "runtime/passes/geometry.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/passes/targets.hpp"
#include "runtime/renderer.hpp"
#include "scene/clip_range.hpp"

namespace tureen {

namespace {

/// A plan that draws all faces and stores all values. It allows only specialisations of the
/// network's code, which are exact.
RenderPlan make_debug_view_plan(const TriangleSoup& soup, const DeviceLimits& limits,
                                const DebugViewOptions& options) {
  SpecialisationSet wanted;
  wanted.add(Specialisation::weight_uniforms);
  wanted.add(Specialisation::dead_neurons);
  RenderPlan plan = make_plan(soup, limits,
                              {.specialisations = wanted,
                               .reversed_depth = options.reversed_depth,
                               .site = ShadingSite::deferred});
  plan.latent_features = feature_count(soup) > 4;
  return plan;
}

const char* shader_of(const TriangleSoup& soup) {
  return std::holds_alternative<LatticeTexture>(soup.appearance) ? "debug_view_lattice.glsl"
         : std::holds_alternative<UvTextures>(soup.appearance)   ? "debug_view_uv.glsl"
                                                                 : "debug_view_plain.glsl";
}

/// The appearance with the additional stores that face_corners.glsl and debug_view.frag read.
AppearanceSource debug_view_appearance(const TriangleSoup& soup, const RenderPlan& plan,
                                       const TexelLayout& layout) {
  AppearanceSource appearance = prepare_appearance(soup, plan, layout);
  std::vector<glm::vec3> corners;
  corners.reserve(3 * plan.faces.size());
  for (const std::uint32_t face : plan.faces)
    for (int k = 0; k < 3; ++k) corners.push_back(soup.positions[soup.triangles[face][k]]);
  appearance.samplers.push_back(
      {"corners", TexelSource::of(texel_formats::rgb32f, std::move(corners), "corners")});
  appearance.samplers.push_back(
      {"soup_faces", TexelSource::of(texel_formats::r32ui, plan.faces, "faces")});
  appearance.fit_layout(layout);
  return appearance;
}

/// The shader constant of a debug view: SHOW_DEPTH for "depth".
std::string constant_of(const DebugViewName& debug_view) {
  std::string constant = std::string("SHOW_") + debug_view.name;
  for (char& c : constant) c = c == '-' ? '_' : c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
  return constant;
}

/// Factor of the colours below the wireframe's lines.
constexpr const char* dimmed = "0.4";

}  // namespace

struct DebugViewRenderer::State {
  State(const gl::Capabilities& capabilities, const TriangleSoup& soup, glm::dvec3 soup_origin,
        const DebugViewOptions& options);

  const gl::Program& geometry_program(const char* fragment, bool alpha_test);
  const gl::Program& shown_program();
  void resize(int width, int height);
  void draw(const FrameCamera& frame);
  void draw_faces(const gl::Program& program, const FrameCamera& frame);
  void draw_visibility(const FrameCamera& frame);
  void draw_shown(const FrameCamera& frame);
  void draw_edges(const FrameCamera& frame);
  void draw_overdraw(const FrameCamera& frame);
  void draw_full_screen(const gl::Program& program);
  void set_corners(const gl::Program& program, const FrameCamera& frame) const;

  gl::Capabilities device;
  glm::dvec3 origin;
  glm::vec4 background;
  Bounds all, middle;
  const char* shader;
  std::optional<int> blend_channel;
  std::array<std::optional<std::string>, 10> refusals;  // by DebugView
  int features = 0;
  RenderPlan plan;
  DeviceAppearance appearance;
  Geometry geometry;
  gl::LocalVertexArray nothing;
  FrontToBack order;
  std::map<std::string, gl::Program> programs;

  DebugView what = DebugView::color;
  FeatureChoice choice;
  DepthScale scale;
  int width = 0, height = 0;
  gl::Texture depth, color, counts;
  gl::Framebuffer color_framebuffer, counts_framebuffer;
  FragmentStore store;
};

DebugViewRenderer::State::State(const gl::Capabilities& capabilities, const TriangleSoup& soup,
                                glm::dvec3 soup_origin, const DebugViewOptions& options)
    : device(capabilities),
      origin(soup_origin),
      background(options.background),
      all(bounds(soup)),
      middle(middle_bounds(soup)),
      shader(shader_of(soup)),
      features(feature_count(soup)),
      plan(make_debug_view_plan(soup, device_limits(capabilities), options)),
      appearance(debug_view_appearance(soup, plan, TexelLayout::of(device_limits(capabilities)))),
      geometry(prepare_geometry(soup, plan.faces)) {
  for (const DebugViewName& name : debug_view_names())
    refusals[std::size_t(name.what)] = why_not(name.what, soup);
  if (const auto* texture = std::get_if<LatticeTexture>(&soup.appearance); texture && texture->mlp)
    blend_channel = texture->mlp->blend_channel;
  if (const auto* textures = std::get_if<UvTextures>(&soup.appearance); textures && textures->mlp)
    blend_channel = textures->mlp->blend_channel;
  gl::check("DebugViewRenderer");
}

// -- programs, created on first use -------------------------------------------------------------

const gl::Program& DebugViewRenderer::State::geometry_program(const char* fragment,
                                                              bool alpha_test) {
  const std::string key = std::string(fragment) + (alpha_test ? " tested" : "");
  const auto known = programs.find(key);
  if (known != programs.end()) return known->second;
  ShaderSource source{.file = fragment,
                      .constants = appearance.constants,
                      .generated = {{"appearance.glsl", appearance.glsl}}};
  source.constants["ALPHA_TEST"] = alpha_test ? "1" : "0";
  source.constants["LINE_PIXELS"] = "1.0";
  source.constants["LINE_COLOR"] = "vec3(0.94)";
  const ShaderSource vertex{.file = "geometry.vert"};
  gl::Program program(assemble(vertex, device.api), assemble(source, device.api));
  return programs.emplace(key, std::move(program)).first->second;
}

const gl::Program& DebugViewRenderer::State::shown_program() {
  const std::string key = what == DebugView::mlp_weight ? "features" : name_of(what);
  const auto known = programs.find(key);
  if (known != programs.end()) return known->second;
  ShaderSource source{
      .file = what == DebugView::overdraw ? "overdraw.frag" : "debug_view.frag",
      .constants = appearance.constants,
      .generated = {{"appearance.glsl", appearance.glsl},
                    {"debug_view_appearance.glsl", std::string("#include \"") + shader + "\"\n"}}};
  for (const DebugViewName& name : debug_view_names())
    source.constants[constant_of(name)] = std::to_string(int(name.what));
  source.constants["SHOWN"] = std::to_string(int(what));
  source.constants["NO_FACE"] = "0xffffffffu";
  source.constants["COLOR_SCALE"] = what == DebugView::wireframe ? dimmed : "1.0";
  const ShaderSource vertex{.file = "full_screen.vert"};
  gl::Program program(assemble(vertex, device.api), assemble(source, device.api));
  return programs.emplace(key, std::move(program)).first->second;
}

// -- the passes ---------------------------------------------------------------------------------

void DebugViewRenderer::State::resize(int new_width, int new_height) {
  width = height = 0;  // if a target throws, the next frame resizes again
  color = make_target(target_formats::rgba8, new_width, new_height);
  counts = make_target(target_formats::rgba8, new_width, new_height);
  depth = make_target(plan.reversed_depth ? target_formats::depth32f : target_formats::depth24,
                      new_width, new_height);
  color_framebuffer = make_framebuffer({color.id()}, depth.id());
  counts_framebuffer = make_framebuffer({counts.id()}, 0);
  store = FragmentStore(new_width, new_height, depth.id());
  width = new_width;
  height = new_height;
}

void DebugViewRenderer::State::draw(const FrameCamera& frame) {
  gl::use_plain_rasterisation(width, height);
  if (plan.reversed_depth) gl::use_zero_to_one_depth(device.api, true);
  if (what == DebugView::overdraw) {
    draw_overdraw(frame);
  } else {
    draw_visibility(frame);
    draw_shown(frame);
    if (what == DebugView::wireframe) draw_edges(frame);
  }
  if (plan.reversed_depth) gl::use_zero_to_one_depth(device.api, false);
  gl::check("DebugViewRenderer::draw");
}

/// In the drawing order of ordinary frames.
void DebugViewRenderer::State::draw_faces(const gl::Program& program, const FrameCamera& frame) {
  if (plan.clusters.empty()) return;
  program.use();
  appearance.bind(program);
  geometry.bind();
  const glm::dmat4 projection =
      plan.reversed_depth ? clip_from_view_reversed(frame.camera, frame.range.near)
                          : clip_from_view(frame.camera, frame.range.near, frame.range.far);
  Geometry::set_camera(program, frame, projection);
  set_corners(program, frame);
  const glm::dvec3 forward = -frame.camera.world_from_view_rotation()[2];
  order.sort(plan.clusters, glm::vec3(frame.eye), glm::vec3(forward));
  const auto first = order.first_vertices(), count = order.vertex_counts();
#ifndef __EMSCRIPTEN__
  if (device.multi_draw) {
    glMultiDrawArrays(GL_TRIANGLES, first.data(), count.data(), static_cast<GLsizei>(first.size()));
    return;
  }
#endif
  for (std::size_t i = 0; i < first.size(); ++i) glDrawArrays(GL_TRIANGLES, first[i], count[i]);
}

void DebugViewRenderer::State::draw_visibility(const FrameCamera& frame) {
  store.begin();
  const float far = plan.reversed_depth ? 0.0f : 1.0f;
  glClearBufferfv(GL_DEPTH, 0, &far);
  glDepthFunc(plan.reversed_depth ? GL_GREATER : GL_LESS);
  draw_faces(geometry_program("visibility.frag", what != DebugView::alpha), frame);
}

void DebugViewRenderer::State::draw_shown(const FrameCamera& frame) {
  const gl::Program& program = shown_program();
  glBindFramebuffer(GL_FRAMEBUFFER, color_framebuffer.id());
  program.use();
  appearance.bind(program);
  set_eye(program, frame.eye);
  set_rays(program, frame.camera);
  set_corners(program, frame);
  program.set("background", background);
  program.set("depth_scale",
              glm::vec2(std::log(scale.near), 1.0 / std::log(scale.far / scale.near)));
  const bool weight = what == DebugView::mlp_weight;
  program.set("first_feature", weight ? blend_channel.value_or(0) : choice.first);
  program.set("features_shown", weight ? 1 : choice.count);
  store.bind(program, appearance.unit_count());
  draw_full_screen(program);
}

/// Edges have the depth of their faces. The depth test passes edges of visible faces, and edges in
/// front of them, where the alpha test rejected the face.
void DebugViewRenderer::State::draw_edges(const FrameCamera& frame) {
  glBindFramebuffer(GL_FRAMEBUFFER, color_framebuffer.id());
  glDepthMask(GL_FALSE);
  glDepthFunc(plan.reversed_depth ? GL_GEQUAL : GL_LEQUAL);
  draw_faces(geometry_program("wireframe.frag", false), frame);
  glDepthMask(GL_TRUE);
}

void DebugViewRenderer::State::draw_overdraw(const FrameCamera& frame) {
  glBindFramebuffer(GL_FRAMEBUFFER, counts_framebuffer.id());
  const float none[4] = {0, 0, 0, 0};
  glClearBufferfv(GL_COLOR, 0, none);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
  draw_faces(geometry_program("fragment_count.frag", false), frame);
  glDisable(GL_BLEND);

  const gl::Program& program = shown_program();
  glBindFramebuffer(GL_FRAMEBUFFER, color_framebuffer.id());
  program.use();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, counts.id());
  gl::use_texture_sampling(0);
  program.set("counts", 0);
  program.set("background", background);
  draw_full_screen(program);
}

void DebugViewRenderer::State::draw_full_screen(const gl::Program& program) {
  glDisable(GL_DEPTH_TEST);
  program.set("background_depth", 0.0f);
  nothing.bind();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
}

/// The uniforms of face_corners.glsl: window y points up, image y down.
void DebugViewRenderer::State::set_corners(const gl::Program& program,
                                           const FrameCamera& frame) const {
  const Camera& camera = frame.camera;
  const glm::dmat3 axes = camera.world_from_view_rotation();
  program.set("view_axis", glm::vec3(-axes[2]));
  program.set("window_x", glm::vec3(camera.fx * axes[0] - camera.cx * axes[2]));
  program.set("window_y", glm::vec3(camera.fy * axes[1] - (camera.height - camera.cy) * axes[2]));
}

// -- the class ----------------------------------------------------------------------------------

DebugViewRenderer::DebugViewRenderer(const gl::Context& context, const TriangleSoup& soup,
                                     glm::dvec3 origin, const DebugViewOptions& options) {
  gl::use_plain_pixel_transfer();
  state_ = std::make_unique<State>(context.capabilities(), soup, origin, options);
}

DebugViewRenderer::~DebugViewRenderer() = default;
DebugViewRenderer::DebugViewRenderer(DebugViewRenderer&&) noexcept = default;
DebugViewRenderer& DebugViewRenderer::operator=(DebugViewRenderer&&) noexcept = default;

void DebugViewRenderer::show(DebugView what, const FeatureChoice& features) {
  if (const auto& refusal = state_->refusals[std::size_t(what)]) throw UsageError(*refusal);
  if (what == DebugView::features)
    if (const auto refusal = why_not(features, state_->features)) throw UsageError(*refusal);
  state_->what = what;
  state_->choice = features;
}

void DebugViewRenderer::set_background(glm::vec4 background) { state_->background = background; }

void DebugViewRenderer::draw(const Camera& camera) {
  State& state = *state_;
  assert(camera.width > 0 && camera.height > 0);
  require_drawable(camera.width, camera.height, state.device.max_image_side);
  if (camera.width != state.width || camera.height != state.height)
    state.resize(camera.width, camera.height);
  const glm::dvec3 eye = camera.eye() - state.origin;
  const DepthStorage storage =
      state.plan.reversed_depth ? DepthStorage::reversed_float : DepthStorage::fixed_24;
  state.scale = depth_scale(state.middle, eye);
  state.draw({camera, eye, clip_range(state.all, eye, forward_of(camera), storage)});
}

void DebugViewRenderer::finish() const { glFinish(); }

Image8 DebugViewRenderer::read_color() const {
  assert(state_->width > 0 && "no frame has been drawn");
  return read_pixels(state_->color_framebuffer.id(), state_->width, state_->height);
}

std::vector<std::uint32_t> DebugViewRenderer::read_faces() const {
  if (state_->what == DebugView::overdraw) return {};
  return read_visible_faces(state_->store.framebuffer(), {state_->width, state_->height},
                            state_->plan.faces);
}

std::vector<std::uint8_t> DebugViewRenderer::read_fragment_counts() const {
  if (state_->what != DebugView::overdraw) return {};
  const Image8 image = read_pixels(state_->counts_framebuffer.id(), state_->width, state_->height);
  std::vector<std::uint8_t> result(image.pixels.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = image.pixels[i].r;
  return result;
}

void DebugViewRenderer::blit_to(unsigned framebuffer) const {
  blit_color(state_->color_framebuffer.id(), framebuffer, {state_->width, state_->height});
}

Legend DebugViewRenderer::legend() const {
  return tureen::legend(state_->what, state_->scale, state_->choice);
}

void DebugViewRenderer::leave_context() {
  finish();
  state_->geometry.leave_context();
  state_->nothing.forget();
  state_->color_framebuffer = {};
  state_->counts_framebuffer = {};
  state_->store = {};
  state_->width = state_->height = 0;
}

std::size_t DebugViewRenderer::device_bytes() const {
  return state_->appearance.device_bytes() + state_->geometry.device_bytes();
}

}  // namespace tureen
