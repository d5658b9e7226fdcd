#include "runtime/shading_pass.hpp"

#include <cassert>

#include "runtime/geometry.hpp"

namespace tureen {

ShadingPass::ShadingPass(const RenderPlan& plan, const ShadingSources& sources) : plan_(plan) {
  if (plan.shading_stage != ShadingStage::compute)
    fragment_ = gl::Program(sources.vertex, sources.fragment);
  if (plan.shading_stage != ShadingStage::fragment)
    compute_ = gl::Program::compute(sources.compute);
}

bool ShadingPass::must_measure(const Frame& frame) const {
  if (plan_.shading_stage != ShadingStage::measured) return false;
  const double pixels = double(frame.width) * frame.height;
  // Not at every size: while a window is being resized each frame has its own.
  return !choice_ || pixels >= 4 * measured_pixels_ || 4 * pixels <= measured_pixels_;
}

void ShadingPass::draw(const Frame& frame, gl::PassTimer* timer) {
  if (must_measure(frame)) {
    choice_ = choose_shading_stage(
        {.shade = [&](ShadingStage stage) { draw(frame, stage); }, .finish = [] { glFinish(); }});
    measured_pixels_ = double(frame.width) * frame.height;
  }
  const gl::TimedPass pass(timer, "shading");
  draw(frame, choice_ ? choice_->stage : plan_.shading_stage);
}

void ShadingPass::draw(const Frame& frame, ShadingStage stage) {
  glBindFramebuffer(GL_FRAMEBUFFER, frame.color_framebuffer);
  if (plan_.depth_rejects_background) glClearBufferfv(GL_COLOR, 0, &frame.background[0]);
  if (stage == ShadingStage::compute)
    compute(frame);
  else
    draw_fragments(frame);
}

void ShadingPass::draw_fragments(const Frame& frame) {
  glDepthMask(GL_FALSE);
  // The triangle lies at the cleared depth: it passes exactly where something nearer was drawn.
  glDepthFunc(!plan_.depth_rejects_background ? GL_ALWAYS
              : plan_.reversed_depth          ? GL_LESS
                                              : GL_GREATER);
  set_uniforms(fragment_, frame);
  fragment_.set("background_depth", plan_.reversed_depth ? 0.0f : 1.0f);
  nothing_.bind();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
}

void ShadingPass::compute(const Frame& frame) const {
#ifdef __EMSCRIPTEN__
  (void)frame;
  assert(false && "WebGL has no compute shaders");
#else
  set_uniforms(compute_, frame);
  glBindImageTexture(0, frame.color_texture, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
  const auto groups = [](int size) {
    return static_cast<GLuint>((size + shading_group_side - 1) / shading_group_side);
  };
  glDispatchCompute(groups(frame.width), groups(frame.height), 1);
  // The picture is read, blitted and cleared as a framebuffer's, and sampled by filters.
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                  GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
#endif
}

void ShadingPass::set_uniforms(const gl::Program& program, const Frame& frame) const {
  program.use();
  frame.appearance.bind(program);
  set_rays(program, frame.camera.camera);
  set_eye(program, frame.camera.eye);
  program.set("background", frame.background);
  frame.store.bind(program, frame.appearance.unit_count());
}

}  // namespace tureen
