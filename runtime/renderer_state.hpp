// The members of a Renderer, shared by its source files.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/gl/state.hpp"
#include "runtime/passes/accumulation.hpp"
#include "runtime/passes/depth_probe.hpp"
#include "runtime/passes/filter_pass.hpp"
#include "runtime/passes/soup_passes.hpp"
#include "runtime/renderer.hpp"
#include "runtime/splats/ordered_splats.hpp"
#include "runtime/splats/splat_target.hpp"
#include "runtime/splats/tile_pass.hpp"
#include "scene/clip_range.hpp"

namespace tureen {

struct Renderer::State {
  State(const gl::Context& context, PreparedScene& prepared, const RenderOptions& options)
      : plan(std::move(prepared.plan)),
        background(options.background),
        splat_format(options.splat_format),
        device(context.capabilities()) {
    gl::use_plain_pixel_transfer();
    upload(prepared.layers, plan.layers);
    draws_layers = !prepared.make_passes;
    arrange();
    if (prepared.make_passes) passes = prepared.make_passes({device, plan, soups});
    if (!has_one_sample_a_pixel(plan.quality)) filter.emplace(plan.quality, device.api);
  }

  struct Place {
    PlacedBounds box;
    bool visible = true;
  };

  void upload(std::vector<PreparedLayer>& layers, std::span<const LayerPlan> plans);
  bool has_splats() const;
  void arrange();
  void make_splat_pass();
  void drop_splat_pass();
  void upload_tiled_splats();
  void remove(std::size_t layer);
  template <class Add>
  void add_or_undo(const Add& add);
  FrameFormat format() const;

  /// Calls act(pass) for each pass in order, without the filter.
  template <class Act>
  void for_each_pass(const Act& act) {
    if (draws_layers) {
      for (const SoupPasses& each : soup_passes)
        if (each.faces) act(*each.faces);
      for (const SoupPasses& each : soup_passes)
        if (each.shading) act(*each.shading);
      if (splat_pass) act(*splat_pass);
    }
    for (const std::unique_ptr<Pass>& pass : passes) act(*pass);
  }
  template <class Act>
  void for_each_pass_and_filter(const Act& act) {
    for_each_pass(act);
    if (filter) act(*filter);
  }

  GLuint image_framebuffer() const {
    if (rest && rest->frames() > 0) return rest->image_framebuffer();
    return frame_framebuffer();
  }
  /// Without the image at rest.
  GLuint frame_framebuffer() const {
    return filter ? filter->framebuffer() : target.color_framebuffer();
  }
  DepthStorage depth_storage() const {
    return plan.reversed_depth ? DepthStorage::reversed_float : DepthStorage::fixed_24;
  }
  void resize(glm::ivec2 new_size);
  void set_frame(const FrameInput& input);
  void draw(const FrameInput& input);
  bool splats_in_order() const { return !ordered_splats || ordered_splats->in_order(); }
  bool begin_rest();
  double splat_depth_at(glm::ivec2 sample, float stored);

  RenderPlan plan;  // soups and passes refer to it
  std::vector<Place> places;
  glm::vec4 background;
  SplatFormat splat_format;
  gl::Capabilities device;
  FrameTarget target{{}};
  // One for each layer; null for layers of the other kind. Splats are in one of the lists, or in
  // both after upload_tiled_splats().
  std::vector<std::unique_ptr<DeviceSoup>> soups;
  std::vector<std::unique_ptr<DeviceSplats>> splats;
  std::vector<std::unique_ptr<TiledSplats>> tiled_splats;
  bool layered = false;                 // the passes are those of several soups
  bool draws_layers = true;             // otherwise `passes` are all passes
  std::vector<SoupPasses> soup_passes;  // one for each layer, if they are drawn
  std::unique_ptr<SplatSorter> splat_sorter;
  std::unique_ptr<SplatBlendingPass> splat_pass;  // of all layers of splats
  OrderedSplats* ordered_splats = nullptr;        // of the pass, if the device blends
  Passes passes;                                  // from outside
  std::optional<FilterPass> filter;               // for other than one sample a pixel
  glm::ivec2 size{0};                             // of the last image; 0 before the first
  Frame frame;                                    // the last one
  Camera camera;                                  // of the last frame, at the image's size
  gl::PassTimer* timer = nullptr;
  std::optional<DepthProbe> probe;
  std::optional<FrameInput> shown;   // of the last draw(), unless it has failed or is out of date
  std::optional<Accumulation> rest;  // made by refine()
  bool rest_refused = false;         // the device lacks the memory for it
  std::vector<PlacedBounds> visible_boxes;  // for set_frame()
};

}  // namespace tureen
