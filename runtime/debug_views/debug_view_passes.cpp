#include "runtime/debug_views/debug_view_passes.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/debug_views/measure_pass.hpp"
#include "runtime/passes/full_screen.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/passes/soup_passes.hpp"
#include "runtime/splats/splat_pass.hpp"
#include "scene/middle_bounds.hpp"

namespace tureen {

namespace {

/// Factor of the colours below the wireframe's lines and between holes.
constexpr const char* dimmed = "0.4";

/// The shader constant of a debug view: SHOW_DEPTH for "depth".
std::string constant_of(const DebugViewName& debug_view) {
  std::string constant = std::string("SHOW_") + debug_view.name;
  for (char& c : constant) c = c == '-' ? '_' : c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
  return constant;
}

/// The full-screen program that shows a debug view, or with SHOW_SURFACE the soup's surface.
gl::Program shown_program(const DeviceSoup& soup, const DebugViewSubject& subject, DebugView what,
                          bool surface = false) {
  DeviceSoup::Constants constants = debug_view_constants(what);
  constants["SHOW_SURFACE"] = "-1";
  if (surface) constants["SHOWN"] = "SHOW_SURFACE";
  constants["NO_FACE"] = "0xffffffffu";
  constants["COLOR_SCALE"] =
      what == DebugView::wireframe || what == DebugView::holes ? dimmed : "1.0";
  const gl::Api api = soup.device().api;
  return gl::Program(
      assemble({.file = "full_screen.vert"}, api),
      soup.source(
          what == DebugView::overdraw ? "overdraw.frag" : "debug_view.frag", constants,
          {{"debug_view_appearance.glsl", std::string("#include \"") + subject.shader + "\"\n"}}));
}

gl::Program face_program(const DeviceSoup& soup, const char* fragment) {
  return soup.face_program(
      fragment, {{"ALPHA_TEST", "0"}, {"LINE_PIXELS", "1.0"}, {"LINE_COLOR", "vec3(0.94)"}});
}

/// The uniforms of face_corners.glsl: window y points up, image y down.
void set_corners(const gl::Program& program, const Camera& camera) {
  const glm::dmat3 axes = camera.world_from_view_rotation();
  program.set("view_axis", glm::vec3(-axes[2]));
  program.set("window_x", glm::vec3(camera.fx * axes[0] - camera.cx * axes[2]));
  program.set("window_y", glm::vec3(camera.fy * axes[1] - (camera.height - camera.cy) * axes[2]));
}

/// Colours the visible fragments by a stored or geometric value. With `surface`, writes their
/// normals and depths to this framebuffer instead, which has the frame's depth.
class ValuePass final : public Pass {
 public:
  ValuePass(const DeviceSoup& soup, std::span<const DebugViewSubject> subjects,
            ShownDebugView& shown, const gl::Framebuffer* surface = nullptr)
      : soup_(soup),
        subjects_(subjects),
        shown_(shown),
        surface_(surface),
        program_(shown_program(soup, subjects[soup.slots().layer], shown.what, surface)) {}

  const char* name() const override { return "debug view"; }
  void draw(const Frame& frame, FrameTarget& target) override {
    const std::size_t layer = soup_.slots().layer;
    const FrameCamera& view = frame.layers[layer];
    const DebugViewSubject& subject = subjects_[layer];
    const DepthScale scale = shown_.scale = depth_scale_of(frame, subjects_);
    if (target.layered()) {
      target.draw_samples_of(layer);
    } else {
      target.overwrite_color();
    }
    if (surface_) glBindFramebuffer(GL_FRAMEBUFFER, surface_->id());
    program_.use();
    soup_.appearance().bind(program_);
    set_eye(program_, view.eye);
    set_rays(program_, view.camera);
    set_corners(program_, view.camera);
    program_.set("background", frame.background);
    program_.set("depth_scale", glm::vec2(std::log(scale.near / view.scale),
                                          1.0 / std::log(scale.far / scale.near)));
    program_.set("world_from_layer", glm::mat3(view.world_from_layer));
    program_.set("world_scale", static_cast<float>(view.scale));
    program_.set("layer", static_cast<int>(layer));
    soup_.set_first_slot(program_);
    const bool weight = shown_.what == DebugView::mlp_weight;
    program_.set("first_feature",
                 weight ? subject.blend_channel.value_or(0) : shown_.features.first);
    program_.set("features_shown", weight ? 1 : shown_.features.count);
    target.bind_visibility(program_, soup_.appearance().unit_count());
    full_screen_.draw(program_, target.far_depth());
  }
  void leave_context() override { full_screen_.leave_context(); }

 private:
  const DeviceSoup& soup_;
  std::span<const DebugViewSubject> subjects_;
  ShownDebugView& shown_;
  const gl::Framebuffer* surface_;
  gl::Program program_;
  FullScreen full_screen_;
};

/// Draws the edges of the faces. Edges have the depth of their faces. The depth test passes edges
/// of visible faces, and edges in front of them, where the alpha test rejected the face.
class EdgePass final : public Pass {
 public:
  explicit EdgePass(DeviceSoup& soup)
      : soup_(soup), program_(face_program(soup, "wireframe.frag")) {}
  const char* name() const override { return "edges"; }
  void draw(const Frame& frame, FrameTarget& target) override {
    const FrameCamera& view = frame.layers[soup_.slots().layer];
    if (!view.visible) return;
    target.draw_color();
    glDepthMask(GL_FALSE);
    glDepthFunc(target.nearer_or_equal());
    program_.use();
    set_corners(program_, view.camera);
    soup_.draw_faces(program_, program_, view, target);
  }

 private:
  DeviceSoup& soup_;
  gl::Program program_;
};

/// Marks holes, over the colours of all layers.
class HolePass final : public Pass {
 public:
  explicit HolePass(gl::Api api)
      : program_(full_screen_program(
            {.file = "holes.frag", .constants = {{"NO_FACE", "0xffffffffu"}}}, api)) {}
  const char* name() const override { return "holes"; }
  void draw(const Frame&, FrameTarget& target) override {
    target.draw_color();
    glDisable(GL_DEPTH_TEST);
    program_.use();
    target.bind_visibility(program_, 0);
    program_.set("hole_color", glm::vec4(hole_color, 1.0f));
    full_screen_.draw(program_);
  }
  void leave_context() override { full_screen_.leave_context(); }

 private:
  gl::Program program_;
  FullScreen full_screen_;
};

/// Colours the fragment counts.
class OverdrawPass final : public Pass {
 public:
  OverdrawPass(const DeviceSoup& soup, const DebugViewSubject& subject,
               const FragmentCountPass& counts)
      : counts_(counts), program_(shown_program(soup, subject, DebugView::overdraw)) {}
  const char* name() const override { return "debug view"; }
  void draw(const Frame& frame, FrameTarget& target) override {
    target.overwrite_color();
    program_.use();
    program_.set_texture("counts", 0, counts_.texture());
    program_.set("background", frame.background);
    full_screen_.draw(program_);
  }
  void leave_context() override { full_screen_.leave_context(); }

 private:
  const FragmentCountPass& counts_;
  gl::Program program_;
  FullScreen full_screen_;
};

const char* shader_of(const TriangleSoup& soup) {
  return std::holds_alternative<LatticeTexture>(soup.appearance) ? "debug_view_lattice.glsl"
         : std::holds_alternative<UvTextures>(soup.appearance)   ? "debug_view_uv.glsl"
                                                                 : "debug_view_plain.glsl";
}

/// The final colours of the splats, or of some of them.
std::unique_ptr<Pass> splat_color_pass(std::span<DeviceSplats* const> splats, float fraction) {
  return std::make_unique<SplatPass>(splats.front()->device(), splats, SplatFormat::automatic,
                                     fraction);
}

/// Measures the splats, if there are any, and the soups. `counts` as MeasurePass::Inputs.
std::unique_ptr<MeasurePass> measure_pass(std::span<DeviceSoup* const> soups,
                                          std::span<DeviceSplats* const> splats,
                                          std::span<const DebugViewSubject> subjects,
                                          ShownDebugView& shown, const FragmentCountPass* counts) {
  const auto make_surfaces = [&](const gl::Framebuffer& surface) {
    Passes passes;
    for (DeviceSoup* soup : soups)
      passes.push_back(std::make_unique<ValuePass>(*soup, subjects, shown, &surface));
    return passes;
  };
  return std::make_unique<MeasurePass>(MeasurePass::Inputs{
      .device = splats.empty() ? soups.front()->device() : splats.front()->device(),
      .splats = splats,
      .subjects = subjects,
      .shown = shown,
      .counts = counts,
      .make_surfaces = make_surfaces});
}

}  // namespace

DebugViewSubject::DebugViewSubject(const Splats& splats) : middle(middle_bounds(splats)) {
  for (const DebugViewName& name : debug_view_names())
    refusals.push_back(why_not(name.what, splats));
}

DebugViewSubject::DebugViewSubject(const TriangleSoup& soup)
    : middle(middle_bounds(soup)), shader(shader_of(soup)), features(feature_count(soup)) {
  for (const DebugViewName& name : debug_view_names()) refusals.push_back(why_not(name.what, soup));
  if (const auto* texture = std::get_if<LatticeTexture>(&soup.appearance); texture && texture->mlp)
    blend_channel = texture->mlp->blend_channel;
  if (const auto* textures = std::get_if<UvTextures>(&soup.appearance); textures && textures->mlp)
    blend_channel = textures->mlp->blend_channel;
}

DepthScale depth_scale_of(const Frame& frame, std::span<const DebugViewSubject> subjects) {
  DepthScale all;
  bool first = true;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    const FrameCamera& view = frame.layers[i];
    if (!view.visible) continue;
    const DepthScale one = depth_scale(subjects[i].middle, view.eye);
    const double near = one.near * view.scale, far = one.far * view.scale;
    all = first ? DepthScale{near, far}
                : DepthScale{std::min(all.near, near), std::max(all.far, far)};
    first = false;
  }
  return all;
}

std::map<std::string, std::string> debug_view_constants(DebugView what) {
  std::map<std::string, std::string> constants;
  for (const DebugViewName& name : debug_view_names())
    constants[constant_of(name)] = std::to_string(int(name.what));
  constants["SHOWN"] = std::to_string(int(what));
  return constants;
}

FragmentCountPass::FragmentCountPass(std::span<DeviceSoup* const> soups) {
  for (DeviceSoup* soup : soups)
    drawings_.push_back({*soup, face_program(*soup, "fragment_count.frag")});
}

void FragmentCountPass::resize(const FrameTarget& target) {
  size_ = target.size();
  counts_ = make_target(target_formats::rgba8, size_.x, size_.y);
  framebuffer_ = make_framebuffer({counts_.id()});
}

void FragmentCountPass::draw(const Frame& frame, FrameTarget& target) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  const float none[4] = {0, 0, 0, 0};
  glClearBufferfv(GL_COLOR, 0, none);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFunc(GL_ONE, GL_ONE);
  for (const auto& [soup, program] : drawings_) {
    const FrameCamera& view = frame.layers[soup.slots().layer];
    if (view.visible) soup.draw_faces(program, program, view, target);
  }
}

DebugViewPasses debug_view_passes(std::span<DeviceSoup* const> soups,
                                  std::span<DeviceSplats* const> splats,
                                  std::span<const DebugViewSubject> subjects,
                                  ShownDebugView& shown) {
  const bool has_splats = !splats.empty();
  const bool shows_colors = shown.what == DebugView::color || shown.what == DebugView::quarter;
  const bool measures = shown.as_values || (has_splats && !shows_colors);
  DebugViewPasses result;
  const auto add = [&](std::unique_ptr<Pass> pass) { result.passes.push_back(std::move(pass)); };
  if (shown.what == DebugView::overdraw && !soups.empty()) {
    auto counts = std::make_unique<FragmentCountPass>(soups);
    result.counts = counts.get();
    add(std::move(counts));
    if (!measures) {
      const DeviceSoup& soup = *soups.front();
      add(std::make_unique<OverdrawPass>(soup, subjects[soup.slots().layer], *result.counts));
      return result;
    }
  }
  const AlphaTest test =
      shown.what == DebugView::alpha && !measures ? AlphaTest::never : AlphaTest::as_planned;
  for (DeviceSoup* soup : soups) add(make_visibility_pass(*soup, test));
  if (measures) {
    // Splats are grey over the alpha of soups; every other view is computed from the surfaces.
    if (shown.what == DebugView::alpha && !shown.as_values)
      for (DeviceSoup* soup : soups) add(std::make_unique<ValuePass>(*soup, subjects, shown));
    auto pass = measure_pass(soups, splats, subjects, shown, result.counts);
    result.measures = pass.get();
    add(std::move(pass));
    return result;
  }
  for (DeviceSoup* soup : soups) add(std::make_unique<ValuePass>(*soup, subjects, shown));
  if (shown.what == DebugView::wireframe)
    for (DeviceSoup* soup : soups) add(std::make_unique<EdgePass>(*soup));
  if (shown.what == DebugView::holes) add(std::make_unique<HolePass>(soups.front()->device().api));
  if (has_splats)
    add(splat_color_pass(splats, shown.what == DebugView::quarter ? shown_fraction : 1.0f));
  return result;
}

}  // namespace tureen
