#include "runtime/passes/soup_passes.hpp"

#include <cassert>

#include "runtime/passes/shader_source.hpp"

namespace tureen {

namespace {

/// Draws the planned faces with one fragment shader, with and without alpha test.
class FaceDrawing {
 public:
  FaceDrawing(DeviceSoup& soup, std::size_t layer, const char* fragment, AlphaTest test)
      : soup_(soup), layer_(layer) {
    const char* tested = test == AlphaTest::as_planned ? "1" : "0";
    const SoupPlan& plan = soup.plan();
    if (plan.opaque_count > 0) opaque_ = soup.face_program(fragment, {{"ALPHA_TEST", "0"}});
    if (plan.opaque_count < plan.faces.size())
      cut_out_ = soup.face_program(fragment, {{"ALPHA_TEST", tested}});
  }
  void draw(const Frame& frame, const FrameTarget& target) {
    soup_.draw_faces(opaque_, cut_out_, frame.layers[layer_], target);
  }

 private:
  DeviceSoup& soup_;
  std::size_t layer_;
  gl::Program opaque_, cut_out_;
};

class VisibilityPass final : public Pass {
 public:
  VisibilityPass(DeviceSoup& soup, std::size_t layer, AlphaTest test)
      : faces_(soup, layer, "visibility.frag", test) {}
  const char* name() const override { return "visibility"; }
  void draw(const Frame& frame, FrameTarget& target) override {
    target.draw_visibility();
    faces_.draw(frame, target);
  }

 private:
  FaceDrawing faces_;
};

/// The only pass of a forward plan, and of ShadingSite::nowhere, which keeps the background's
/// colour.
class ForwardPass final : public Pass {
 public:
  ForwardPass(DeviceSoup& soup, std::size_t layer)
      : writes_color_(soup.plan().site == ShadingSite::forward),
        faces_(soup, layer, writes_color_ ? "forward.frag" : "nothing.frag",
               AlphaTest::as_planned) {}
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
  ShadingPass(DeviceSoup& soup, std::size_t layer)
      : soup_(soup), plan_(soup.plan()), layer_(layer) {
    const DeviceSoup::Constants constants{
        {"NO_FACE", "0xffffffffu"},
        {"DEPTH_REJECTS_BACKGROUND", plan_.depth_rejects_background ? "1" : "0"},
        {"GROUP_SIDE", std::to_string(shading_group_side)}};
    program_ = plan_.shading_stage == ShadingStage::compute
                   ? gl::Program::compute(soup.source("shading.comp", constants))
                   : gl::Program(assemble({.file = "full_screen.vert"}, soup.device().api),
                                 soup.source("shading.frag", constants));
  }
  const char* name() const override { return "shading"; }

  void draw(const Frame& frame, FrameTarget& target) override {
    plan_.depth_rejects_background ? target.draw_color() : target.overwrite_color();
    if (plan_.shading_stage == ShadingStage::compute)
      compute(frame, target);
    else
      draw_fragments(frame, target);
  }

  void leave_context() override { nothing_.forget(); }

 private:
  void draw_fragments(const Frame& frame, const FrameTarget& target) {
    glDepthMask(GL_FALSE);
    // The triangle lies at the cleared depth: it passes exactly where something nearer was drawn.
    glDepthFunc(!plan_.depth_rejects_background ? GL_ALWAYS
                : target.reversed_depth()       ? GL_LESS
                                                : GL_GREATER);
    set_uniforms(frame, target);
    program_.set("background_depth", target.far_depth());
    nothing_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

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
    const FrameCamera& camera = frame.layers[layer_];
    const DeviceAppearance& appearance = soup_.appearance();
    program_.use();
    appearance.bind(program_);
    set_rays(program_, camera.camera);
    set_eye(program_, camera.eye);
    program_.set("background", frame.background);
    target.bind_visibility(program_, appearance.unit_count());
  }

  const DeviceSoup& soup_;
  const SoupPlan& plan_;
  std::size_t layer_;
  gl::Program program_;
  gl::LocalVertexArray nothing_;
};

}  // namespace

std::unique_ptr<Pass> make_visibility_pass(DeviceSoup& soup, std::size_t layer, AlphaTest test) {
  return std::make_unique<VisibilityPass>(soup, layer, test);
}

Passes soup_passes(std::span<const std::unique_ptr<DeviceSoup>> soups) {
  Passes passes;
  for (std::size_t i = 0; i < soups.size(); ++i)
    if (soups[i]->plan().site == ShadingSite::deferred)
      passes.push_back(make_visibility_pass(*soups[i], i));
    else
      passes.push_back(std::make_unique<ForwardPass>(*soups[i], i));
  for (std::size_t i = 0; i < soups.size(); ++i)
    if (soups[i]->plan().site == ShadingSite::deferred)
      passes.push_back(std::make_unique<ShadingPass>(*soups[i], i));
  gl::check("soup_passes");
  return passes;
}

}  // namespace tureen
