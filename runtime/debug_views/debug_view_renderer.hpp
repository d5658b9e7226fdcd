// Draws the debug views of runtime/debug_views/debug_view.hpp for a soup, frame by frame. As in
// Renderer, the same faces cover the same pixels, with the exceptions below.
//
// It has its own buffers and textures of the stored soup: no specialisation is applied, and
// ordinary frames are independent of it. GL state is treated as in Renderer.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "image/image.hpp"
#include "runtime/debug_views/debug_view.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/plan/plan.hpp"
#include "scene/camera.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

struct DebugViewOptions {
  bool reversed_depth = true;  // if the device supports it, as in PlanPreferences
  /// Colour and alpha of pixels without content.
  glm::vec4 background{0.0f, 0.0f, 0.0f, 1.0f};
};

class DebugViewRenderer {
 public:
  /// The soup is not needed afterwards. It must have no defect(). Throws DeviceLimitError if it
  /// does not fit.
  DebugViewRenderer(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                    const DebugViewOptions& options = {});
  ~DebugViewRenderer();
  DebugViewRenderer(DebugViewRenderer&&) noexcept;
  DebugViewRenderer& operator=(DebugViewRenderer&&) noexcept;

  /// Selects the debug view of the next frames, default DebugView::color. Throws UsageError with
  /// the sentence of why_not().
  void show(DebugView what, const FeatureChoice& features = {});

  void set_background(glm::vec4 background);

  /// As Renderer::draw. A pixel shows the face or background of an ordinary frame, with three
  /// exceptions for fragments that the alpha test rejects. DebugView::alpha shows the nearest face
  /// even if it is rejected, overdraw counts every fragment, and the wireframe outlines whole
  /// triangles if nothing is in front of them.
  void draw(const Camera& camera);

  /// Waits for the device.
  void finish() const;

  /// The last frame. Row 0 is the top row. Waits for the device. Asserts that there was a frame.
  Image8 read_color() const;

  /// The visible face of each pixel of the last frame, row 0 on top, no_face for the background;
  /// empty for overdraw.
  std::vector<std::uint32_t> read_faces() const;

  /// The fragment count of each pixel of the last overdraw frame, row 0 on top, at most
  /// max_counted_fragments; empty for other debug views.
  std::vector<std::uint8_t> read_fragment_counts() const;

  /// Copies the last frame to a framebuffer of the same size (0 is the window).
  void blit_to(unsigned framebuffer) const;

  /// Legend of the last frame's colours.
  Legend legend() const;

  /// As Renderer::leave_context.
  void leave_context();

  /// Bytes of buffers and textures, without the targets.
  std::size_t device_bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tureen
