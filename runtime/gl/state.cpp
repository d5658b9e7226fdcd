#include "runtime/gl/state.hpp"

#include <cstdint>

#include "runtime/gl/api.hpp"

namespace tureen::gl {

void use_plain_rasterisation(int width, int height) {
  glViewport(0, 0, width, height);
  for (const GLenum unwanted :
       {GL_BLEND, GL_CULL_FACE, GL_DITHER, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_POLYGON_OFFSET_FILL,
        GL_RASTERIZER_DISCARD, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE})
    glDisable(unwanted);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
}

void use_plain_pixel_transfer() {
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  for (const GLenum name :
       {GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_PIXELS,
        GL_UNPACK_SKIP_IMAGES, GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS})
    glPixelStorei(name, 0);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
}

void wait_for_device(unsigned framebuffer) {
#ifdef __EMSCRIPTEN__
  std::uint8_t pixel[4];
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glReadBuffer(framebuffer == 0 ? GL_BACK : GL_COLOR_ATTACHMENT0);
  use_plain_pixel_transfer();
  glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
#else
  (void)framebuffer;
  glFinish();
#endif
}

void use_zero_to_one_depth(Api api, bool zero_to_one) {
#ifndef __EMSCRIPTEN__
  const GLenum depth = zero_to_one ? GL_ZERO_TO_ONE : GL_NEGATIVE_ONE_TO_ONE;
  // Selects by the context's API: a set function pointer may belong to another context.
  if (api == Api::desktop)
    glClipControl(GL_LOWER_LEFT, depth);
  else
    glClipControlEXT(GL_LOWER_LEFT, depth);
#else
  (void)api;
  (void)zero_to_one;
#endif
}

}  // namespace tureen::gl
