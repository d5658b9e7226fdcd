// Draws what runtime/debug_views/inspection.hpp names of a soup, frame by frame, as Renderer draws
// its colours: the same faces in the same pixels, but for what says otherwise.
//
// It has buffers and textures of its own, of the soup as it is stored: nothing is specialised,
// and ordinary frames know nothing of it. GL state is treated as Renderer treats it.
#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <vector>

#include "image/image.hpp"
#include "runtime/debug_views/inspection.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/plan/plan.hpp"
#include "scene/camera.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

struct InspectorOptions {
  bool reversed_depth = true;  // where the device can, as PlanPreferences has it
  /// What pixels become of which nothing is shown.
  glm::vec4 background{0.0f, 0.0f, 0.0f, 1.0f};
};

class Inspector {
 public:
  /// The soup is not needed afterwards. It must have no defect(). Throws DeviceLimitError when it
  /// does not fit.
  Inspector(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
            const InspectorOptions& options = {});
  ~Inspector();
  Inspector(Inspector&&) noexcept;
  Inspector& operator=(Inspector&&) noexcept;

  /// What the next frames show: Inspection::color before the first call. Throws UsageError with
  /// why_not()'s sentence.
  void show(Inspection what, const FeatureChoice& features = {});

  void set_background(glm::vec4 background);

  /// As Renderer::draw. A pixel shows the face that an ordinary frame shows, and the background
  /// where that has none, but for what the alpha test throws away: Inspection::alpha shows the
  /// nearest face whether it exists there or not, overdraw counts every fragment, and the
  /// wireframe's lines outline whole triangles where nothing is before them.
  void draw(const Camera& camera);

  /// Waits for the device.
  void finish() const;

  /// The last frame. Row 0 is the top row. Waits for the device. Asserts that there was a frame.
  Image8 read_color() const;

  /// The face that each pixel of the last frame shows, row 0 on top, no_face where none does; empty
  /// for overdraw.
  std::vector<std::uint32_t> read_faces() const;

  /// How many fragments of overdraw each pixel of the last frame has, row 0 on top, at most
  /// most_counted_fragments; empty where something else was shown.
  std::vector<std::uint8_t> read_fragment_counts() const;

  /// Copies the last frame into a framebuffer of the same size (0 is the window).
  void blit_to(unsigned framebuffer) const;

  /// What the colours of the last frame mean.
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
