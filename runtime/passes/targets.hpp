// Textures and framebuffers of the window's size.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <initializer_list>
#include <span>
#include <vector>

#include "image/image.hpp"
#include "runtime/gl/objects.hpp"
#include "runtime/passes/texel_store.hpp"

namespace tureen {

struct TargetFormat {
  GLenum internal_format, format, type;
  int bytes;  // a pixel; drivers may take more
};

namespace target_formats {
inline constexpr TargetFormat rgba8{GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
inline constexpr TargetFormat rg32ui{GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, 8};
inline constexpr TargetFormat depth24{GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, 4};
inline constexpr TargetFormat depth32f{GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, 4};
}  // namespace target_formats

/// What a target of this size takes.
inline std::size_t bytes_of(const TargetFormat& format, glm::ivec2 size) {
  return static_cast<std::size_t>(format.bytes) * static_cast<std::size_t>(size.x) *
         static_cast<std::size_t>(size.y);
}

/// A texture to draw into; nearest sampling.
gl::Texture make_target(const TargetFormat& format, int width, int height);

/// The same for what compute shaders write; ES lets them write only to storage that never changes.
/// Needs ES 3.0 or OpenGL 4.2.
gl::Texture make_image_target(const TargetFormat& format, int width, int height);

/// `colors` become attachments 0, 1, ..; all of them are drawn to. Leaves it bound. Throws as
/// require_complete_framebuffer().
gl::Framebuffer make_framebuffer(std::initializer_list<GLuint> colors, GLuint depth);

/// The RGBA8 pixels of a framebuffer's first color attachment, row 0 on top. Waits for the device.
Image8 read_pixels(GLuint framebuffer, int width, int height);

/// The faces that shaders/visibility.frag has named in a framebuffer, row 0 on top: `faces` are
/// those of its slots. Waits for the device.
std::vector<std::uint32_t> read_visible_faces(GLuint framebuffer, glm::ivec2 size,
                                              std::span<const std::uint32_t> faces);

/// Copies the colours of one framebuffer into another (0 is the window), its lower left corner to
/// `corner`; that one is
/// bound afterwards.
void blit_color(GLuint from, GLuint to, glm::ivec2 size, glm::ivec2 corner = glm::ivec2(0));

/// Throws DeviceLimitError where either side is above `max_side`.
void require_drawable(int width, int height, int max_side);

/// Throws DeviceLimitError when the framebuffer that is bound cannot be drawn to: plans use formats
/// that OpenGL requires or the device has, so it is memory that a picture of this size lacks.
/// Throws ContextError where the device is gone.
void require_complete_framebuffer();

}  // namespace tureen
