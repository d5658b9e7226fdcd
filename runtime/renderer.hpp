// A scene on a device, drawn frame by frame as a list of passes (runtime/passes/pass.hpp).
//
// Not included: windows, input, loading files, choosing cameras. The context of construction must
// be current for every call and on destruction, unless leave_context() was called.
//
// GL state, for other users of the context: every call sets the state on which it depends, with
// four exceptions. Wireframe (glPolygonMode), logic operations and conditional rendering must be
// off, and the depth range must be GL's default. Calls change programs, vertex arrays,
// framebuffers, buffers, textures, samplers, viewport, tests, masks and pixel storage, and do not
// restore them. The clip control is reset to GL's default.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "image/image.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/plan/plan.hpp"
#include "runtime/prepared_scene.hpp"
#include "runtime/render_options.hpp"
#include "scene/frame_input.hpp"

namespace tureen {

namespace gl {
class PassTimer;
}
class SplatSorter;
class DeviceSoup;
class DeviceSplats;

DeviceLimits device_limits(const gl::Capabilities& capabilities);

/// A face of a layer.
struct VisibleFace {
  std::uint32_t layer = 0;
  std::uint32_t face = no_face;
  bool operator==(const VisibleFace&) const = default;
};

class Renderer {
 public:
  /// Uploads a scene that was prepared for limits within those of the device. Only the background
  /// and the target of splats are used of the options. Throws DeviceLimitError if the device
  /// refuses the memory.
  Renderer(const gl::Context& context, PreparedScene prepared, const RenderOptions& options = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  const RenderPlan& plan() const;

  /// Display-referred colour and alpha of pixels without a face, for later frames.
  void set_background(glm::vec4 background);

  /// The number of layers. Functions below take an index, from 0.
  std::size_t layer_count() const;
  /// Moves a layer. `world_from_layer` is a similarity: Layer's defect() accepts it.
  void place_layer(std::size_t layer, const glm::dmat4& world_from_layer);
  /// Shows or hides a layer. Hidden layers stay on the device.
  void show_layer(std::size_t layer, bool visible);

  // The next functions change the layers. They discard the last frame: call draw() before
  // read_color(), read_faces(), point_at() or blit_to(). Passes from set_passes() may refer to the
  // soups: call set_passes({}) before remove_layer() and swap_layers().

  /// Adds the layers of a scene after the present ones, which stay on the device. Several layers
  /// are all drawn deferred. The quality stays that of the first scene. Requires a scene without
  /// make_passes, no call of set_passes() before, the same choice of reversed depth, and at most
  /// max_layers layers. Throws DeviceLimitError and ContextError, and UsageError if the exact order
  /// of splats is shown and the added splats were not prepared for it; then the layers are as
  /// before.
  void add_layers(PreparedScene prepared);
  /// The same with layers that another renderer of the same device has uploaded, for example in
  /// another thread. If `other` has another context than this renderer, call
  /// other.leave_context() before.
  void add_layers(Renderer other);
  /// Frees the layer's memory on the device. Later layers move up.
  void remove_layer(std::size_t layer);
  /// Changes the order: at equal depth the earlier layer is visible.
  void swap_layers(std::size_t a, std::size_t b);

  /// Adds a pass after those of the layers. If the plan has more or fewer than one sample per
  /// pixel, the filter pass also applies to its result.
  void add_pass(std::unique_ptr<Pass> pass);
  /// Replaces all passes of later frames, also those of the layers. Passes that draw soups must not
  /// outlive them.
  void set_passes(Passes passes);
  /// The soups on the device, for passes that draw them; they live as long as their layer.
  std::vector<DeviceSoup*> soups() const;
  /// The splats on the device, for passes that draw them; they live as long as their layer.
  std::vector<DeviceSplats*> splats() const;

  /// Draws one frame of camera.width x camera.height into its own target. Returns before the device
  /// has finished. Asserts a positive size. Throws DeviceLimitError if the size, in pixels or in
  /// samples, exceeds Capabilities::max_image_side.
  ///
  /// Splats are blended in the order of their depths in this view. With `order` `earlier` and a
  /// sorter, many splats may have the order of an earlier view that looks in a direction at most
  /// max_order_lag away. A frame then waits for sorting only after a larger turn, or if it shows
  /// splats that the order lacks.
  enum class SplatOrdering { exact, earlier };
  void draw(const FrameInput& input, SplatOrdering order = SplatOrdering::exact);

  /// Whether the image shows this input now: draw() had it last, splats are in the order of its
  /// view, and the functions above have not changed the scene or the background since.
  bool shows(const FrameInput& input) const;

  // The image at rest: while nothing changes, further frames of the same input with other sample
  // positions, and their mean (runtime/passes/accumulation.hpp). It has at least 8 x 8 samples a
  // pixel, as an image with Quality::supersampling 8.

  /// Whether this scene has an image at rest other than the frame of draw(). It has not
  /// - with a resolution scale: the user has chosen speed;
  /// - if its visible layers are all splats whose profile has a low pass: one sample at the centre
  ///   of a pixel is then their method's value of it, and the mean would blur it once more;
  ///   stochastic order is an exception, because its frames are noisy;
  /// - with passes from outside, such as debug views and baselines;
  /// - on devices without Capabilities::float_targets.
  bool has_image_at_rest() const;
  /// Whether refine() can add a frame: shows() is true for the last input, and frames are missing.
  bool can_refine() const;
  /// Draws one more frame. After every fourth, read_color() and blit_to() have the mean of all
  /// since draw(); until the first mean, they have the frame of draw(). The other functions below
  /// have the last frame. Requires can_refine(). If the device lacks the memory, the image stays
  /// and can_refine() becomes false.
  void refine();
  /// draw(), and refine() while it can.
  void draw_at_rest(const FrameInput& input);

  /// Sorts splats for frames with SplatOrdering::earlier (runtime/splats/splat_sorter.hpp).
  void sort_splats_with(std::unique_ptr<SplatSorter> sorter);
  /// Whether the last frame shows all splats in the order of its own view. Otherwise, draw the view
  /// again until it does.
  bool splats_in_order() const;

  /// Waits for the device.
  void finish() const;

  /// Later frames report the times of their passes to this timer (runtime/gl/timer_query.hpp); null
  /// disables it. It must outlive them. For benchmarks.
  void time_passes(gl::PassTimer* timer);

  /// The last frame. Row 0 is the top row. Waits for the device. Asserts that there was a frame.
  Image8 read_color() const;

  /// Columns and rows of samples of the last frame: the image's own size, except for plans with a
  /// resolution scale or supersampling.
  glm::ivec2 sample_size() const;

  /// The visible face of each sample of the last frame: sample_size() entries, row 0 on top,
  /// no_face for the background. Empty if no pass stores faces, as in forward plans.
  std::vector<VisibleFace> read_faces() const;

  /// The blended splats of the last frame without the soups behind them: premultiplied RGBA for
  /// each sample, row 0 on top. Colours may exceed 1. Empty without splats.
  std::vector<glm::vec4> read_splats() const;

  /// The visible point, in world coordinates, at a place of the last image, in pixels from the top
  /// left corner: that of the splat at which the transmittance falls to 1/2 or below, or else that
  /// of the soups. Returns nullopt outside the image, for the background, and if no pass stores
  /// depth, as in DebugView::overdraw of soups. On soups, its precision is that of the depth
  /// buffer; on splats, that of floats (SplatMeasures). Draws all splats about ten times, in one
  /// pixel, and waits for the device. With tiles, the first call copies the splats to the device,
  /// where they stay. Throws DeviceLimitError.
  std::optional<glm::dvec3> point_at(glm::dvec2 place);

  /// Copies the last frame to a framebuffer (0 is the window), its lower left corner to `corner`.
  void blit_to(unsigned framebuffer, glm::ivec2 corner = glm::ivec2(0)) const;

  /// Releases the last frame and the objects of the current context (vertex arrays and
  /// framebuffers). Afterwards another context of the same share group may be current. A loading
  /// thread uses this to pass a renderer to the window's context. Waits for the device.
  void leave_context();

  /// Bytes of the scene's buffers and textures, without the targets. Includes the copy of the
  /// corners for small-triangle culling, although it is in main memory.
  std::size_t device_bytes() const;

  /// The part of device_bytes() of one layer.
  std::size_t layer_bytes(std::size_t layer) const;

  /// Bytes of the targets at the last frame's size, by their formats; a driver may use more. 0
  /// before the first frame.
  std::size_t target_bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tureen
