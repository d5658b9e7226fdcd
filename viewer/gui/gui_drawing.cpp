#include "viewer/gui/gui_drawing.hpp"

#include <imgui/imgui.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "runtime/gl/api.hpp"
#include "runtime/gl/state.hpp"
#include "runtime/passes/shader_source.hpp"

namespace tureen::viewer {

GuiDrawing::GuiDrawing(gl::Api api)
    : program_(assemble({.file = "interface.vert"}, api),
               assemble({.file = "interface.frag"}, api)),
      vertex_array_(gl::VertexArray::create()),
      vertices_(gl::Buffer::create()),
      indices_(gl::Buffer::create()),
      font_(gl::Texture::create()) {
  static_assert(sizeof(ImDrawIdx) == 2);
  glBindVertexArray(vertex_array_.id());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
  const auto attribute = [](GLuint location, GLint count, GLenum type, GLboolean normalised,
                            std::size_t offset) {
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, count, type, normalised, sizeof(ImDrawVert),
                          // An offset, as GL needs it. NOLINTNEXTLINE(performance-no-int-to-ptr)
                          reinterpret_cast<const void*>(offset));
  };
  attribute(0, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, pos));
  attribute(1, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, uv));
  attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ImDrawVert, col));
  glBindVertexArray(0);

  unsigned char* texels = nullptr;
  int width = 0, height = 0;
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.GetTexDataAsRGBA32(&texels, &width, &height);
  gl::use_plain_pixel_transfer();
  glBindTexture(GL_TEXTURE_2D, font_.id());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
  // A GL name in Dear ImGui's type. NOLINTNEXTLINE(performance-no-int-to-ptr)
  atlas.SetTexID(reinterpret_cast<ImTextureID>(std::uintptr_t(font_.id())));
  gl::check("GuiDrawing");
}

void GuiDrawing::draw(const ImDrawData& data) {
  const auto width = static_cast<int>(data.DisplaySize.x * data.FramebufferScale.x);
  const auto height = static_cast<int>(data.DisplaySize.y * data.FramebufferScale.y);
  if (width <= 0 || height <= 0) return;
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  gl::use_plain_rasterisation(width, height);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_SCISSOR_TEST);
  program_.use();
  program_.set("origin", glm::vec2(data.DisplayPos.x, data.DisplayPos.y));
  program_.set("extent", glm::vec2(data.DisplaySize.x, data.DisplaySize.y));
  program_.set("image", 0);
  glActiveTexture(GL_TEXTURE0);
  glBindSampler(0, 0);  // no sampler object overrides the filters
  glBindVertexArray(vertex_array_.id());
  for (int i = 0; i < data.CmdListsCount; ++i) draw_list(*data.CmdLists[i], data);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glBindVertexArray(0);
  gl::check("GuiDrawing::draw");
}

void GuiDrawing::draw_list(const ImDrawList& list, const ImDrawData& data) {
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  glBufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data,
               GL_STREAM_DRAW);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
               GL_STREAM_DRAW);
  const glm::vec2 scale(data.FramebufferScale.x, data.FramebufferScale.y);
  const float height = data.DisplaySize.y * scale.y;
  for (const ImDrawCmd& command : list.CmdBuffer) {
    const glm::vec4 clip((command.ClipRect.x - data.DisplayPos.x) * scale.x,
                         (command.ClipRect.y - data.DisplayPos.y) * scale.y,
                         (command.ClipRect.z - data.DisplayPos.x) * scale.x,
                         (command.ClipRect.w - data.DisplayPos.y) * scale.y);
    if (clip.z <= clip.x || clip.w <= clip.y) continue;
    // GL counts rows from the bottom.
    glScissor(static_cast<int>(std::max(clip.x, 0.0f)), static_cast<int>(height - clip.w),
              static_cast<int>(clip.z - std::max(clip.x, 0.0f)), static_cast<int>(clip.w - clip.y));
    glBindTexture(GL_TEXTURE_2D,
                  static_cast<GLuint>(reinterpret_cast<std::uintptr_t>(command.GetTexID())));
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), GL_UNSIGNED_SHORT,
                   // An offset, as above. NOLINTNEXTLINE(performance-no-int-to-ptr)
                   reinterpret_cast<const void*>(std::uintptr_t(command.IdxOffset) * 2));
  }
}

}  // namespace tureen::viewer
