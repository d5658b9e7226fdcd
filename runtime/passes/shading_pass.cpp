#include "runtime/passes/shading_pass.hpp"

#include <cassert>

#include "runtime/passes/geometry.hpp"

namespace tureen {

ShadingPass::ShadingPass(const RenderPlan& plan, const ShadingSources& sources) : plan_(plan) {
  program_ = plan.shading_stage == ShadingStage::compute
                 ? gl::Program::compute(sources.compute)
                 : gl::Program(sources.vertex, sources.fragment);
}

void ShadingPass::draw(const Frame& frame, gl::PassTimer* timer) {
  const gl::TimedPass pass(timer, "shading");
  glBindFramebuffer(GL_FRAMEBUFFER, frame.color_framebuffer);
  if (plan_.depth_rejects_background) glClearBufferfv(GL_COLOR, 0, &frame.background[0]);
  if (plan_.shading_stage == ShadingStage::compute)
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
  set_uniforms(frame);
  program_.set("background_depth", plan_.reversed_depth ? 0.0f : 1.0f);
  nothing_.bind();
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
}

void ShadingPass::compute(const Frame& frame) const {
#ifdef __EMSCRIPTEN__
  (void)frame;
  assert(false && "WebGL has no compute shaders");
#else
  set_uniforms(frame);
  glBindImageTexture(0, frame.color_texture, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA8);
  const auto groups = [](int size) {
    return static_cast<GLuint>((size + shading_group_side - 1) / shading_group_side);
  };
  glDispatchCompute(groups(frame.width), groups(frame.height), 1);
  // The image is later read, blitted and cleared as a framebuffer, and sampled by filters.
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                  GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
#endif
}

void ShadingPass::set_uniforms(const Frame& frame) const {
  program_.use();
  frame.appearance.bind(program_);
  set_rays(program_, frame.camera.camera);
  set_eye(program_, frame.camera.eye);
  program_.set("background", frame.background);
  frame.store.bind(program_, frame.appearance.unit_count());
}

}  // namespace tureen
