// A soup on the device: its appearance, its corners, and the drawing of its planned faces.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/passes/appearance_source.hpp"
#include "runtime/passes/covered_faces.hpp"
#include "runtime/passes/geometry.hpp"
#include "runtime/plan/draw_order.hpp"
#include "runtime/plan/plan.hpp"

namespace tureen {

/// An appearance on the device.
struct DeviceAppearance {
  struct Sampler {
    std::string name;  // of the uniform
    TexelStore store;
  };

  std::string glsl;                              // as in AppearanceSource
  std::map<std::string, std::string> constants;  // likewise
  std::vector<Sampler> samplers;
  ColorMlpSource mlp;

  /// Reads the source's texels; they are not needed afterwards. Throws DeviceLimitError.
  explicit DeviceAppearance(AppearanceSource source);

  std::size_t device_bytes() const;
  /// Binds the stores to units 0.. and sets samplers and network weights of `program`, which is in
  /// use.
  void bind(const gl::Program& program) const;
  /// The first texture unit that bind() leaves free.
  int unit_count() const { return static_cast<int>(samplers.size()); }
};

class DeviceSoup {
 public:
  using Constants = std::map<std::string, std::string>;

  /// Uploads; the sources are not needed afterwards. `plan` outlives this object. Throws
  /// DeviceLimitError.
  DeviceSoup(const gl::Capabilities& device, AppearanceSource appearance,
             const GeometrySource& geometry, const SoupPlan& plan);

  /// The soup's place among the layers of a frame.
  struct Slots {
    std::size_t layer = 0;
    /// The visibility texture numbers the slots of all layers consecutively. This is the number of
    /// this layer's first slot.
    std::uint32_t first_slot = 0;
    bool layered = false;  // the frame has several layers
  };
  /// Programs made for another value of `layered` are invalid afterwards.
  void set_slots(const Slots& slots) { slots_ = slots; }
  const Slots& slots() const { return slots_; }
  /// Sets the first slot of `program`, which is in use and was made by this object.
  void set_first_slot(const gl::Program& program) const;

  const SoupPlan& plan() const { return plan_; }
  const gl::Capabilities& device() const { return device_; }
  const DeviceAppearance& appearance() const { return appearance_; }

  /// Complete GLSL for a file that reads the appearance.
  std::string source(const char* file, const Constants& constants,
                     const Constants& generated = {}) const;
  /// The program that draws faces with this fragment shader.
  gl::Program face_program(const char* fragment, const Constants& constants) const;

  /// Draws the planned faces into the bound framebuffer of `target`. Faces without alpha test come
  /// first; each group is drawn from near to far. A program may be empty if its group has no faces.
  /// Sets the uniforms of geometry.vert, of the appearance and of view_direction.glsl.
  void draw_faces(const gl::Program& opaque, const gl::Program& cut_out, const FrameCamera& camera,
                  const FrameTarget& target);

  std::size_t device_bytes() const;
  /// See Renderer::leave_context().
  void leave_context() { geometry_.leave_context(); }

 private:
  void draw_clusters(const gl::Program& program, std::span<const Cluster> clusters,
                     const FrameCamera& camera, const FrameTarget& target);
  void draw_covered(std::span<const std::int32_t> first, std::span<const std::int32_t> count);

  const SoupPlan& plan_;
  Slots slots_;
  gl::Capabilities device_;
  DeviceAppearance appearance_;
  Geometry geometry_;
  FrontToBack order_;
  std::optional<CoveredFaces> covered_;  // if small triangles are culled
  gl::Buffer covered_vertices_;
  std::vector<std::uint32_t> vertices_;  // for the last draw_covered()
  int subpixel_bits_ = 0;
  /// Culling costs time for every face. If more than this fraction of the faces remains, the next
  /// frames draw all faces; the image is the same.
  static constexpr double worthwhile = 0.7;
  static constexpr int retry_interval = 30;  // the search is then retried every 30 frames
  int frames_until_retry_ = 0;               // frames
};

}  // namespace tureen
