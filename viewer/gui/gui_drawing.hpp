// Draws the output of Dear ImGui with the runtime's GL objects: textured triangles in window
// coordinates, blended and clipped to rectangles. Internal to viewer/gui.
#pragma once

#include "runtime/gl/context.hpp"
#include "runtime/gl/objects.hpp"
#include "runtime/gl/program.hpp"

struct ImDrawData;
struct ImDrawList;

namespace tureen::viewer {

class GuiDrawing {
 public:
  /// Uploads the font atlas of the current Dear ImGui context.
  explicit GuiDrawing(gl::Api api);

  /// Draws over the window's framebuffer. The texture id of a draw command is a GL name.
  void draw(const ImDrawData& data);

 private:
  void draw_list(const ImDrawList& list, const ImDrawData& data);

  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertices_, indices_;
  gl::Texture font_;
};

}  // namespace tureen::viewer
