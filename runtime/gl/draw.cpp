#include "runtime/gl/draw.hpp"

#include "runtime/gl/api.hpp"

#ifdef __EMSCRIPTEN__
#include <webgl/webgl1_ext.h>
#endif

namespace tureen::gl {

void draw_runs(const Capabilities& capabilities, std::span<const std::int32_t> first,
               std::span<const std::int32_t> counts) {
  const auto runs = static_cast<GLsizei>(first.size());
  if (!capabilities.multi_draw) {
    for (std::size_t i = 0; i < first.size(); ++i) glDrawArrays(GL_TRIANGLES, first[i], counts[i]);
    return;
  }
#ifdef __EMSCRIPTEN__
  glMultiDrawArraysWEBGL(GL_TRIANGLES, first.data(), counts.data(), runs);
#else
  glMultiDrawArrays(GL_TRIANGLES, first.data(), counts.data(), runs);
#endif
}

}  // namespace tureen::gl
