// One step of a frame. Renderer draws its passes in order, all into one FrameTarget. A module
// outside runtime/ can implement passes of its own and add them to a Renderer (jobs/baseline).
#pragma once

#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "runtime/passes/frame_target.hpp"
#include "scene/clip_range.hpp"
#include "scene/frame_input.hpp"

namespace tureen {

/// One frame's camera in the coordinates of a layer. A point gets the same value in the depth
/// buffer as with the camera in world coordinates.
struct FrameCamera {
  /// The camera's rotation includes the layer's rotation and mirror. The camera's translation is
  /// not used; `eye` replaces it.
  Camera camera;
  glm::dvec3 eye;
  ClipRange range;
  glm::dmat3 world_from_layer{1.0};  // the rotation or reflection
  double scale = 1;                  // world units per layer unit
  bool visible = true;
};

/// The camera in the coordinates of a layer. `world_from_layer` is a similarity; `range` is in
/// world units. If `world_from_layer` is only a translation, FrameCamera::camera equals `camera`.
FrameCamera camera_in_layer(const Camera& camera, const glm::dmat4& world_from_layer,
                            const ClipRange& range);

/// The data of a frame that its passes share.
struct Frame {
  FrameInput input;                 // width and height are those of the samples
  ClipRange range;                  // in world units
  glm::vec4 background;             // display-referred colour and alpha
  std::vector<FrameCamera> layers;  // for each layer of the scene
  /// Whether splats may be blended in the order of an earlier view.
  bool may_use_earlier_order = false;
  /// With supersampling, samples per pixel along each axis; otherwise 1, also with a resolution
  /// scale. Low passes of splats are in pixels with supersampling, and in samples with a scale.
  double samples_per_pixel = 1;
  /// Added to the place of a sample where it selects random numbers (stochastic splats), so that
  /// the frames of an image at rest have different ones.
  glm::ivec2 first_sample{0};
};

class Pass {
 public:
  virtual ~Pass() = default;

  /// The name in results: "visibility", "shading", .. Static storage.
  virtual const char* name() const = 0;
  /// Called before the first frame and when the size changes, after the target was resized: creates
  /// textures of the pass's own, and framebuffers that use the target's textures. Throws
  /// DeviceLimitError.
  virtual void resize(const FrameTarget& target) { (void)target; }
  /// Draws. Before each pass, the viewport is the whole target, depth is tested and written, and
  /// blending, culling and the other tests are off (gl::use_plain_rasterisation). With reversed
  /// depth, clip space has depth from 0 to 1. A pass binds its target itself.
  virtual void draw(const Frame& frame, FrameTarget& target) = 0;
  /// Bytes of the pass's own buffers and textures, without those that depend on the image's size.
  virtual std::size_t device_bytes() const { return 0; }
  /// Bytes of the textures that resize() created.
  virtual std::size_t target_bytes() const { return 0; }
  /// See Renderer::leave_context(). The caller calls resize() before the next draw().
  virtual void leave_context() {}
};

using Passes = std::vector<std::unique_ptr<Pass>>;

}  // namespace tureen
