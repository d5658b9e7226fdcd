// The passes of the debug views (runtime/debug_views/debug_view.hpp). They draw soups whose plan
// keeps all faces and all stored values (debug_views.hpp).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/debug_views/debug_view.hpp"
#include "runtime/passes/device_soup.hpp"
#include "runtime/passes/pass.hpp"

namespace tureen {

/// Facts of a soup that its debug views need.
struct DebugViewSubject {
  /// The soup is not needed afterwards.
  explicit DebugViewSubject(const TriangleSoup& soup);

  Bounds middle;       // middle_bounds()
  const char* shader;  // the file that reads the stored values
  std::optional<int> blend_channel;
  int features = 0;                                     // feature_count()
  std::array<std::optional<std::string>, 10> refusals;  // why_not(), by DebugView
};

/// The shown debug view, and the scale of its colours.
struct ShownDebugView {
  DebugView what = DebugView::color;
  FeatureChoice features;
  DepthScale scale;  // of the last frame; a pass sets it
};

/// Counts the fragments of each sample, in a texture of its own.
class FragmentCountPass final : public Pass {
 public:
  explicit FragmentCountPass(std::span<const std::unique_ptr<DeviceSoup>> soups);

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

struct DebugViewPasses {
  Passes passes;
  const FragmentCountPass* counts = nullptr;  // one of them, for DebugView::overdraw
};

/// The passes that show `shown.what`. The arguments must outlive them; there is a subject for each
/// soup, and at least one soup.
DebugViewPasses debug_view_passes(std::span<const std::unique_ptr<DeviceSoup>> soups,
                                  std::span<const DebugViewSubject> subjects,
                                  ShownDebugView& shown);

}  // namespace tureen
