#include "runtime/passes/soup_passes.hpp"

#include <cassert>

#include "runtime/passes/full_screen.hpp"
#include "runtime/passes/shader_source.hpp"

namespace tureen {

namespace {

/// Draws the planned faces with one fragment shader, with and without alpha test.
class FaceDrawing {
 public:
  FaceDrawing(DeviceSoup& soup, const char* fragment, AlphaTest test) : soup_(soup) {
    const char* tested = test == AlphaTest::as_planned ? "1" : "0";
    const SoupPlan& plan = soup.plan();
    if (plan.opaque_count > 0) opaque_ = soup.face_program(fragment, {{"ALPHA_TEST", "0"}});
    if (plan.opaque_count < plan.faces.size())
      cut_out_ = soup.face_program(fragment, {{"ALPHA_TEST", tested}});
  }
  void draw(const Frame& frame, const FrameTarget& target) {
    const FrameCamera& camera = frame.layers[soup_.slots().layer];
    if (camera.visible) soup_.draw_faces(opaque_, cut_out_, camera, target);
  }

 private:
  DeviceSoup& soup_;
  gl::Program opaque_, cut_out_;
};

class VisibilityPass final : public Pass {
 public:
  VisibilityPass(DeviceSoup& soup, AlphaTest test)
      : soup_(soup), faces_(soup, "visibility.frag", test) {}
  const char* name() const override { return "visibility"; }
  void draw(const Frame& frame, FrameTarget& target) override {
    target.draw_visibility(soup_.slots().layer);
    faces_.draw(frame, target);
  }

 private:
  const DeviceSoup& soup_;
  FaceDrawing faces_;
};

/// The only pass of a forward plan, and of ShadingSite::nowhere, which keeps the background's
/// colour.
class ForwardPass final : public Pass {
 public:
  explicit ForwardPass(DeviceSoup& soup)
      : writes_color_(soup.plan().site == ShadingSite::forward),
        faces_(soup, writes_color_ ? "forward.frag" : "nothing.frag", AlphaTest::as_planned) {}
  const char* name() const override { return "forward"; }
  void draw(const Frame& frame, FrameTarget& target) override {
    target.draw_color();
    if (!writes_color_) glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    faces_.draw(frame, target);
  }

 private:
  bool writes_color_;
  FaceDrawing faces_;
};

/// Colours the covered samples, by a triangle over the whole target or, if the plan requests it, by
/// a compute shader.
class ShadingPass final : public Pass {
 public:
  explicit ShadingPass(DeviceSoup& soup)
      : soup_(soup),
        stage_(soup.plan().shading_stage),
        depth_rejects_background_(soup.plan().depth_rejects_background) {
    const DeviceSoup::Constants constants{
        {"NO_FACE", "0xffffffffu"},
        {"DEPTH_REJECTS_BACKGROUND", depth_rejects_background_ ? "1" : "0"},
        {"GROUP_SIDE", std::to_string(shading_group_side)}};
    program_ = stage_ == ShadingStage::compute
                   ? gl::Program::compute(soup.source("shading.comp", constants))
                   : gl::Program(assemble({.file = "full_screen.vert"}, soup.device().api),
                                 soup.source("shading.frag", constants));
  }
  const char* name() const override { return "shading"; }

  void draw(const Frame& frame, FrameTarget& target) override {
    if (stage_ == ShadingStage::compute) {
      depth_rejects_background_ ? target.draw_color() : target.overwrite_color();
      compute(frame, target);
      return;
    }
    const std::size_t layer = soup_.slots().layer;
    if (depth_rejects_background_) {
      target.draw_samples_of(layer);
    } else {
      target.overwrite_color();
    }
    if (!frame.layers[layer].visible && target.layered()) return;
    set_uniforms(frame, target);
    full_screen_.draw(program_, target.far_depth());
  }

  void leave_context() override { full_screen_.leave_context(); }

 private:
  void compute(const Frame& frame, const FrameTarget& target) const {
#ifdef __EMSCRIPTEN__
    (void)frame;
    (void)target;
    assert(false && "WebGL has no compute shaders");
#else
    set_uniforms(frame, target);
    glBindImageTexture(0, target.color_texture(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
    const auto groups = [](int size) {
      return static_cast<GLuint>((size + shading_group_side - 1) / shading_group_side);
    };
    glDispatchCompute(groups(target.size().x), groups(target.size().y), 1);
    // The image is later read, blitted and cleared as a framebuffer, and sampled by filters.
    glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
#endif
  }

  void set_uniforms(const Frame& frame, const FrameTarget& target) const {
    const FrameCamera& camera = frame.layers[soup_.slots().layer];
    const DeviceAppearance& appearance = soup_.appearance();
    program_.use();
    appearance.bind(program_);
    set_rays(program_, camera.camera);
    set_eye(program_, camera.eye);
    program_.set("background", frame.background);
    soup_.set_first_slot(program_);
    target.bind_visibility(program_, appearance.unit_count());
  }

  const DeviceSoup& soup_;
  ShadingStage stage_;
  bool depth_rejects_background_;
  gl::Program program_;
  FullScreen full_screen_;
};

}  // namespace

std::unique_ptr<Pass> make_visibility_pass(DeviceSoup& soup, AlphaTest test) {
  return std::make_unique<VisibilityPass>(soup, test);
}

SoupPasses make_soup_passes(DeviceSoup& soup) {
  SoupPasses passes;
  if (soup.plan().site == ShadingSite::deferred) {
    passes.faces = make_visibility_pass(soup);
    passes.shading = std::make_unique<ShadingPass>(soup);
  } else {
    passes.faces = std::make_unique<ForwardPass>(soup);
  }
  gl::check("make_soup_passes");
  return passes;
}

}  // namespace tureen
