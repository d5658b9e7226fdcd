// Blends the splats of all layers over the frame's soups on the processor (splatting/), and
// composites them over the frame's colours. On software OpenGL this takes a fraction of the time of
// SplatPass (docs/benchmarks.md), and has the same picture.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/threads/thread_pool.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/splats/splat_target.hpp"
#include "scene/quality.hpp"
#include "splatting/tiles/tile_renderer.hpp"

namespace tureen {

/// A layer of splats for TilePass.
struct TiledSplats {
  std::unique_ptr<splatting::Layer> splats;
  SplatProfile profile;
  std::size_t layer = 0;  // index in Frame::layers
};

class TilePass final : public SplatBlendingPass {
 public:
  /// `layers` outlive the pass. `order` is centre or exact.
  TilePass(const gl::Capabilities& device, std::vector<const TiledSplats*> layers,
           Quality::SplatOrder order);

  void resize(const FrameTarget& target) override;
  void draw(const Frame& frame, FrameTarget& target) override;
  std::size_t target_bytes() const override;
  void leave_context() override;

  std::vector<glm::vec4> read_blended() override;

 private:
  void read_depths(const Frame& frame, const FrameTarget& target);
  /// act(row, rgba) for each row of blended pixels, row 0 on top; several threads call it.
  template <class Act>
  void draw_rows(const Act& act);
  void draw_over_colors(FrameTarget& target);
  void draw_over_background(FrameTarget& target);

  std::vector<const TiledSplats*> layers_;
  splatting::BlendOrder order_;
  ThreadPool pool_;
  splatting::TileRenderer renderer_;
  glm::ivec2 size_{0};
  SplatTarget blended_;
  bool has_texture_ = false;  // whether blended_ has this size
  gl::Program depth_bits_;
  FullScreen full_screen_;
  gl::Texture bits_;  // made when soups are drawn
  gl::Framebuffer bits_framebuffer_;
  std::vector<splatting::LayerInView> views_;  // of the last frame
  // Row 0 on top; in world units, infinity where no soup is; empty: no soup anywhere.
  std::vector<float> depths_;
  // Upside down, as OpenGL's textures: blended splats, or the frame's colours.
  std::vector<float> blended_upside_down_;
  std::vector<std::uint32_t> colors_upside_down_;
};

}  // namespace tureen
