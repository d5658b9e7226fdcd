// The passes of the debug views (runtime/debug_views/debug_view.hpp). They draw soups whose plan
// keeps all faces and all stored values (debug_views.hpp), and splats.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/debug_views/debug_view.hpp"
#include "runtime/passes/device_soup.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/splats/device_splats.hpp"

namespace tureen {

/// Facts of a layer that its debug views need.
struct DebugViewSubject {
  /// The primitives are not needed afterwards.
  explicit DebugViewSubject(const TriangleSoup& soup);
  explicit DebugViewSubject(const Splats& splats);

  Bounds middle;                 // middle_bounds()
  const char* shader = nullptr;  // of a soup: the file that reads the stored values
  std::optional<int> blend_channel;
  int features = 0;                                  // feature_count()
  std::vector<std::optional<std::string>> refusals;  // why_not(), by DebugView
};

/// In world units, for all visible layers.
DepthScale depth_scale_of(const Frame& frame, std::span<const DebugViewSubject> subjects);

/// Shader constants: SHOW_DEPTH and so on, and SHOWN with the one of `what`.
std::map<std::string, std::string> debug_view_constants(DebugView what);

/// The shown debug view, and the scale of its colours.
struct ShownDebugView {
  DebugView what = DebugView::color;
  FeatureChoice features;
  bool as_values = false;  // not as colours
  DepthScale scale;        // of the last frame; a pass sets it
};

/// Counts the fragments of each sample, in a texture of its own.
class FragmentCountPass final : public Pass {
 public:
  explicit FragmentCountPass(std::span<DeviceSoup* const> soups);

  const char* name() const override { return "fragment count"; }
  void resize(const FrameTarget& target) override;
  void draw(const Frame& frame, FrameTarget& target) override;
  std::size_t target_bytes() const override { return bytes_of(target_formats::rgba8, size_); }
  void leave_context() override { framebuffer_ = {}; }

  glm::ivec2 size() const { return size_; }
  /// RGBA8: the count is in red.
  GLuint texture() const { return counts_.id(); }
  GLuint framebuffer() const { return framebuffer_.id(); }

 private:
  struct Drawing {
    DeviceSoup& soup;
    gl::Program program;
  };
  std::vector<Drawing> drawings_;  // for each soup
  glm::ivec2 size_{0};
  gl::Texture counts_;
  gl::Framebuffer framebuffer_;
};

class MeasurePass;

struct DebugViewPasses {
  Passes passes;
  // Some of them, or null:
  const FragmentCountPass* counts = nullptr;  // for DebugView::overdraw of soups
  const MeasurePass* measures = nullptr;      // for splats, and for values
};

/// The passes that show `shown.what`. What the arguments refer to must outlive them; there is a
/// subject for each layer, and at least one layer.
DebugViewPasses debug_view_passes(std::span<DeviceSoup* const> soups,
                                  std::span<DeviceSplats* const> splats,
                                  std::span<const DebugViewSubject> subjects,
                                  ShownDebugView& shown);

}  // namespace tureen
