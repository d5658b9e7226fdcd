#include "runtime/passes/targets.hpp"

#include <algorithm>
#include <glm/gtc/type_precision.hpp>
#include <string>

#include "base/error.hpp"
#include "runtime/gl/state.hpp"

namespace tureen {

namespace {

/// For the bound texture.
void use_nearest_sampling() {
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

}  // namespace

gl::Texture make_target(const TargetFormat& format, int width, int height) {
  gl::Texture texture = gl::Texture::create();
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format.internal_format), width, height, 0,
               format.format, format.type, nullptr);
  use_nearest_sampling();
  return texture;
}

gl::Texture make_image_target(const TargetFormat& format, int width, int height) {
  gl::Texture texture = gl::Texture::create();
  glBindTexture(GL_TEXTURE_2D, texture.id());
  glTexStorage2D(GL_TEXTURE_2D, 1, format.internal_format, width, height);
  use_nearest_sampling();
  return texture;
}

gl::Framebuffer make_framebuffer(std::initializer_list<GLuint> colors,
                                 const DepthAttachment& depth) {
  return make_framebuffer(std::span(colors.begin(), colors.size()), depth);
}

gl::Framebuffer make_framebuffer(std::span<const GLuint> colors, const DepthAttachment& depth) {
  gl::Framebuffer framebuffer = gl::Framebuffer::create();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  std::vector<GLenum> attachments;
  for (const GLuint color : colors) {
    attachments.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attachments.size()));
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachments.back(), GL_TEXTURE_2D, color, 0);
  }
  if (depth.texture)
    glFramebufferTexture2D(GL_FRAMEBUFFER,
                           depth.has_stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT,
                           GL_TEXTURE_2D, depth.texture, 0);
  glDrawBuffers(static_cast<GLsizei>(attachments.size()), attachments.data());
  require_complete_framebuffer();
  return framebuffer;
}

void require_complete_framebuffer() {
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return;
  gl::throw_if_lost();
  throw DeviceLimitError(
      "the device has no memory for the targets of an image of this size: draw a smaller image");
}

namespace {

/// Reads the first color attachment, or the window for 0. The first row of `pixels` is the top one.
template <class Pixel>
void read_to(std::vector<Pixel>& pixels, GLuint framebuffer, glm::ivec2 size, GLenum format,
             GLenum type) {
  const auto width = std::ptrdiff_t(size.x);
  pixels.resize(std::size_t(size.x) * std::size_t(size.y));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glReadBuffer(framebuffer ? GL_COLOR_ATTACHMENT0 : GL_BACK);
  gl::use_plain_pixel_transfer();
  glReadPixels(0, 0, size.x, size.y, format, type, pixels.data());
  gl::throw_if_lost();
  for (auto top = pixels.begin(), bottom = pixels.end(); bottom - top >= 2 * width; top += width) {
    bottom -= width;
    std::swap_ranges(top, top + width, bottom);
  }
}

}  // namespace

Image8 read_pixels(GLuint framebuffer, int width, int height) {
  Image8 image(width, height);
  read_to(image.pixels, framebuffer, {width, height}, GL_RGBA, GL_UNSIGNED_BYTE);
  return image;
}

std::vector<glm::vec4> read_float_pixels(GLuint framebuffer, glm::ivec2 size) {
  std::vector<glm::vec4> pixels;
  read_to(pixels, framebuffer, size, GL_RGBA, GL_FLOAT);
  return pixels;
}

std::vector<glm::vec4> read_fraction_pixels(GLuint framebuffer, glm::ivec2 size) {
  std::vector<glm::u16vec4> stored;
  read_to(stored, framebuffer, size, GL_RGBA, GL_UNSIGNED_SHORT);
  std::vector<glm::vec4> pixels;
  pixels.reserve(stored.size());
  for (const glm::u16vec4& pixel : stored) pixels.push_back(glm::vec4(pixel) / 65535.0f);
  return pixels;
}

std::vector<std::uint32_t> read_visible_slots(GLuint framebuffer, glm::ivec2 size) {
  // Reading must wait for the pass that wrote this target. Mesa 22.3's llvmpipe waits only for a
  // running pass that writes it. The shading pass only reads it, so an older frame would be
  // returned.
  glFinish();
  // Four channels, although two are stored: ES 3.0 guarantees only this format for integers.
  std::vector<glm::uvec4> fragments;
  read_to(fragments, framebuffer, size, GL_RGBA_INTEGER, GL_UNSIGNED_INT);
  std::vector<std::uint32_t> result;
  result.reserve(fragments.size());
  for (const glm::uvec4& fragment : fragments) result.push_back(fragment.x);
  return result;
}

void blit_color(GLuint from, GLuint to, glm::ivec2 size, glm::ivec2 corner) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
  glDisable(GL_SCISSOR_TEST);
  glBlitFramebuffer(0, 0, size.x, size.y, corner.x, corner.y, corner.x + size.x, corner.y + size.y,
                    GL_COLOR_BUFFER_BIT, GL_NEAREST);
  glBindFramebuffer(GL_FRAMEBUFFER, to);
}

void require_drawable(int width, int height, int max_side) {
  if (std::max(width, height) > max_side)
    throw DeviceLimitError("an image of " + std::to_string(width) + "x" + std::to_string(height) +
                           " exceeds the limit of this device: " + std::to_string(max_side) +
                           " pixels a side");
}

}  // namespace tureen
