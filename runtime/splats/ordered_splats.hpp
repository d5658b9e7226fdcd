// The splats of all layers of a frame, drawn in the order of their centres' view depth, near ones
// first, under the soups' depth.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/passes/frame_target.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/splats/device_splats.hpp"
#include "runtime/splats/splat_order.hpp"
#include "runtime/splats/splat_sorter.hpp"

namespace tureen {

/// The centres of splats in layer coordinates, with their view depth in world units.
SplatsInView in_view(std::span<const glm::vec3> centers, const FrameCamera& camera);

/// Framebuffers of the same colour textures, with and without the frame's depth: some kernels test
/// depth themselves.
struct SplatFramebuffers {
  gl::Framebuffer with_depth, without_depth;
};
SplatFramebuffers make_splat_framebuffers(std::initializer_list<GLuint> colors,
                                          const FrameTarget& target);

class OrderedSplats {
 public:
  /// `layers` outlive this object. `fraction`: of the splats that are drawn
  /// (SplatsInView::fraction).
  explicit OrderedSplats(std::span<DeviceSplats* const> layers, float fraction = 1);
  OrderedSplats(const OrderedSplats&) = delete;
  OrderedSplats& operator=(const OrderedSplats&) = delete;
  ~OrderedSplats();

  /// `sorter` sorts for frames with Frame::may_use_earlier_order. It outlives this object and
  /// serves no other one. Null: all frames are sorted as they are drawn.
  void sort_with(SplatSorter* sorter);
  /// Whether the last prepare() was for a frame whose order is that of its own view.
  bool in_order() const { return in_order_; }

  /// Projects and orders the splats of the visible layers for the next draw() of this frame.
  /// `color_unit` is the value of colour 1.
  void prepare(const Frame& frame, float color_unit = 1);
  /// Places in the order.
  struct Range {
    std::uint32_t begin, end;
  };
  /// Sets plain rasterisation without writing depth, which is tested if the frame has any. Then
  /// binds a framebuffer.
  void begin(FrameTarget& target, const SplatFramebuffers& framebuffers) const;
  /// The same, and clears the first colours to `value`.
  void begin(FrameTarget& target, const SplatFramebuffers& framebuffers,
             const glm::vec4& value) const;
  /// Draws with the current blending, after begin().
  void draw(const Frame& frame, FrameTarget& target, const SplatFramebuffers& framebuffers,
            const SplatDrawing& drawing, Range range);
  /// Draws all splats.
  void draw(const Frame& frame, FrameTarget& target, const SplatFramebuffers& framebuffers,
            const SplatDrawing& drawing) {
    draw(frame, target, framebuffers, drawing, {0, count()});
  }

  /// Whether Specialisation::hidden_splats applies to all layers.
  bool may_skip_hidden() const;
  /// No splat has a larger colour.
  float largest_color() const;
  /// The smallest of the layers' SplatProfile::min_alpha.
  float min_alpha() const;

  /// Number of ordered splats.
  std::uint32_t count() const { return static_cast<std::uint32_t>(order_.splats().size()); }
  std::size_t device_bytes() const;

 private:
  void sort_now(std::vector<SplatsInView> views);
  void take_order(const std::vector<SplatsInView>& views);
  void continue_sorting(std::vector<SplatsInView> views);
  void stop_sorting();
  void upload_order();

  std::vector<DeviceSplats*> layers_;
  float fraction_;
  SplatOrder order_;
  std::vector<SplatsInView> ordered_;  // the views of the order
  bool in_order_ = true;
  SplatSorter* sorter_ = nullptr;
  std::optional<std::vector<SplatsInView>> sorting_;  // the views of the sorter's order
  gl::Texture order_texture_;
  int order_rows_ = 0;
};

}  // namespace tureen
