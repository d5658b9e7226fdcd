// A soup on a device, drawn frame by frame.
//
// What it does not do: windows, input, loading files, choosing cameras. The context it was made
// with must be current for every call, and on destruction.
//
// GL state, for whoever shares the context: every call sets what it depends on, save wireframe
// (glPolygonMode), logic operations and conditional rendering, which must be off, and the depth
// range, which must be GL's own. Nothing is restored: programs, vertex arrays, framebuffers,
// buffers, textures, samplers, viewport, tests, masks and pixel storage are ours afterwards. The
// clip control is left at GL's default.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "image/image.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/plan/plan.hpp"
#include "runtime/prepared_soup.hpp"
#include "runtime/render_options.hpp"
#include "scene/camera.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

class Pipeline;
namespace gl {
class PassTimer;
}

DeviceLimits device_limits(const gl::Capabilities& capabilities);

class Renderer {
 public:
  /// Plans and uploads; the soup is not needed afterwards. It must have no defect(). Throws
  /// DeviceLimitError with a forecast when it does not fit, UsageError as make_plan does.
  Renderer(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
           const RenderOptions& options = {});
  /// The same with a plan that make_plan made of this soup, for limits that the device has:
  /// options.plan has no say.
  Renderer(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin, RenderPlan plan,
           const RenderOptions& options = {});
  /// Of what prepare_soup made for limits that the device has; the same pictures. Of the options
  /// only the background has a say. Throws DeviceLimitError where the device refuses.
  Renderer(const gl::Context& context, PreparedSoup prepared, const RenderOptions& options = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  const RenderPlan& plan() const;

  void set_background(glm::vec4 background);

  /// Draws one frame of camera.width x camera.height into a target of its own; returns before the
  /// device has finished. Asserts a positive size; throws DeviceLimitError for one beyond
  /// Capabilities::max_picture_side, in pixels or in samples.
  void draw(const Camera& camera);

  /// Waits for the device.
  void finish() const;

  /// Later frames tell the times of their passes to this timer (runtime/gl/timer_query.hpp), or to
  /// none. It must outlive them. For benchmarks.
  void time_passes(gl::PassTimer* timer);

  /// The last frame. Row 0 is the top row. Waits for the device. Asserts that there was a frame.
  Image8 read_color() const;

  /// Columns and rows of samples that the last frame was drawn with: the picture's own size but for
  /// plans with a resolution scale or supersampling.
  glm::ivec2 sample_size() const;

  /// The face that each sample of the last frame shows, sample_size() of them, row 0 on top,
  /// no_face where none does. Empty when the plan shades forward.
  std::vector<std::uint32_t> read_faces() const;

  /// The point, in world coordinates, that the last frame shows at a place of its picture, from the
  /// top left corner in pixels; nothing where it shows the background, and of the published
  /// pipeline, whose depth cannot be read. As exact as the depth buffer. Waits for the
  /// device.
  std::optional<glm::dvec3> point_at(glm::dvec2 place);

  /// Copies the last frame into a framebuffer (0 is the window), its lower left corner to `corner`.
  void blit_to(unsigned framebuffer, glm::ivec2 corner = glm::ivec2(0)) const;

  /// Gives up the last frame and what belongs to the current context alone (vertex arrays and
  /// framebuffers), so that from now on another context of the same share group may be current: a
  /// renderer made on a loading thread moves to the window's so. Waits for the device.
  void leave_context();

  /// Bytes of the scene's buffers and textures, without the targets; with the copy of the corners
  /// by which faces between pixels are found, though that lies beside them.
  std::size_t device_bytes() const;

  /// Bytes of the targets of the last frame's size, as their formats say: a driver may take more. 0
  /// before the first frame.
  std::size_t target_bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tureen
