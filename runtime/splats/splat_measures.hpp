// What is measured of the splats at each pixel besides their colour. The weight of a splat is its
// alpha times the transmittance of the splats in front of it, as for colours.
//
// The search for the splat at which the transmittance falls to a threshold narrows, at each pixel,
// a range of prefixes of the order. A step draws all splats, and multiplies 1 - alpha over four
// prefixes, one in each channel: a fifth of the range remains. 100,000 splats take eight steps.
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/passes/full_screen.hpp"
#include "runtime/splats/ordered_splats.hpp"

namespace tureen {

enum class SplatMeasure {
  sums,  // two textures: sum of weight * (normal, 1); of weight * (depth, opacity, sigma, 1)
  median_depth,  // red: view depth of the splat at which the transmittance falls to 1/2, or 0
  /// Number of blended splats; of those before the transmittance falls to closed_transmittance; 0;
  /// place of the first one in the order of the frame, or above 1e20.
  counts,
};

/// A pixel is closed below this transmittance: SplatProfile::stop_transmittance of all methods.
inline constexpr float closed_transmittance = 1e-4f;

/// Depths are in world units, along the viewing axis: of a window or disc, that of its plane at the
/// pixel; of a Gaussian, that of its centre; of a neural density, the middle of its visible chord.
/// Normals are in world axes, towards the eye: of a Gaussian, the axis of the smallest scale; of a
/// neural density, the ellipsoid's normal where the ray enters it.
///
/// Devices that cannot blend 32-bit floats blend 16-bit floats: sums have steps of 1/2048, counts
/// end at 2048, and places are rounded above 2048 and infinite above 65,504.
class SplatMeasures {
 public:
  /// `layers` outlive this object.
  SplatMeasures(const gl::Capabilities& device, std::span<DeviceSplats* const> layers,
                SplatMeasure what);

  /// Creates textures of the target's size. Throws DeviceLimitError.
  void resize(const FrameTarget& target);
  /// Measures the splats in front of the target's depth.
  void draw(const Frame& frame, FrameTarget& target);

  /// RGBA32F, or RGBA16F. Both are the same but for SplatMeasure::sums.
  GLuint texture(std::size_t i) const { return results_[std::min(i, results_.size() - 1)].id(); }
  GLuint framebuffer() const { return result_framebuffers_.with_depth.id(); }

  /// Number of splats in the last frame's order.
  std::uint32_t splat_count() const { return splats_.count(); }
  std::size_t device_bytes() const { return splats_.device_bytes(); }
  std::size_t target_bytes() const;
  /// See Renderer::leave_context(). resize() must follow.
  void leave_context();

 private:
  void search(const Frame& frame, FrameTarget& target, float threshold);
  void measure_sums(const Frame& frame, FrameTarget& target);
  void measure_median_depth(const Frame& frame, FrameTarget& target);
  void count(const Frame& frame, FrameTarget& target);

  SplatMeasure what_;
  TargetFormat blended_format_;
  OrderedSplats splats_;
  gl::Program narrow_;
  FullScreen full_screen_;
  glm::ivec2 size_{0};
  std::vector<gl::Texture> results_;
  SplatFramebuffers result_framebuffers_;
  /// Of the search: ranges of prefixes, read and written in turn, and transmittances.
  gl::Texture bounds_[2], transmittances_;
  gl::Framebuffer bounds_framebuffers_[2];
  SplatFramebuffers transmittance_framebuffers_;
};

}  // namespace tureen
