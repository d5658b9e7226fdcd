// Textures and framebuffers of the frame's size.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <initializer_list>
#include <span>
#include <vector>

#include "image/image.hpp"
#include "runtime/gl/objects.hpp"
#include "runtime/passes/texel_store.hpp"

namespace tureen {

/// Drivers may take more bytes per pixel.
using TargetFormat = TexelFormat;

namespace target_formats {
using namespace texel_formats;
/// Fractions of 16 bits: GL_RGBA16, and in ES GL_RGBA16_EXT, with Capabilities::norm16_targets.
inline constexpr TargetFormat rgba16{0x805B, GL_RGBA, GL_UNSIGNED_SHORT, 8};
inline constexpr TargetFormat rgba16f{GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8};
inline constexpr TargetFormat depth24{GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, 4};
inline constexpr TargetFormat depth32f{GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4};
// With 8 bits of stencil.
inline constexpr TargetFormat depth24_stencil{GL_DEPTH24_STENCIL8, GL_DEPTH_STENCIL,
                                              GL_UNSIGNED_INT_24_8, 4};
inline constexpr TargetFormat depth32f_stencil{GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL,
                                               GL_FLOAT_32_UNSIGNED_INT_24_8_REV, 8};
}  // namespace target_formats

/// Bytes of a target of this size.
inline std::size_t bytes_of(const TargetFormat& format, glm::ivec2 size) {
  return format.bytes * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

/// A texture as a render target; nearest sampling.
gl::Texture make_target(const TargetFormat& format, int width, int height);

/// The same for output of compute shaders, which in ES need immutable storage. Needs ES 3.0 or
/// OpenGL 4.2.
gl::Texture make_image_target(const TargetFormat& format, int width, int height);

/// A depth texture of a framebuffer.
struct DepthAttachment {
  GLuint texture = 0;  // 0: none
  bool has_stencil = false;
};

/// `colors` become attachments 0, 1, ..; all are draw buffers. The framebuffer stays bound. Throws
/// as require_complete_framebuffer().
gl::Framebuffer make_framebuffer(std::span<const GLuint> colors, const DepthAttachment& depth = {});
gl::Framebuffer make_framebuffer(std::initializer_list<GLuint> colors,
                                 const DepthAttachment& depth = {});

/// The RGBA8 pixels of a framebuffer's first color attachment, row 0 on top. Waits for the device.
Image8 read_pixels(GLuint framebuffer, int width, int height);

/// The same for floats.
std::vector<glm::vec4> read_float_pixels(GLuint framebuffer, glm::ivec2 size);
/// The same for fractions of 16 bits, which ES does not convert to floats.
std::vector<glm::vec4> read_fraction_pixels(GLuint framebuffer, glm::ivec2 size);

/// The slots that shaders/visibility.frag wrote to a framebuffer, row 0 on top; no_face for the
/// background. Waits for the device.
std::vector<std::uint32_t> read_visible_slots(GLuint framebuffer, glm::ivec2 size);

/// Copies the colours of one framebuffer to another (0 is the window), its lower left corner to
/// `corner`. The destination stays bound.
void blit_color(GLuint from, GLuint to, glm::ivec2 size, glm::ivec2 corner = glm::ivec2(0));

/// Throws DeviceLimitError if either side exceeds `max_side`.
void require_drawable(int width, int height, int max_side);

/// Throws DeviceLimitError if the bound framebuffer cannot be drawn to. Its formats are required by
/// OpenGL or supported by the device, so the cause is insufficient memory. Throws ContextError if
/// the device is lost.
void require_complete_framebuffer();

}  // namespace tureen
