// The members of a Renderer, shared by its source files.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/device_layer.hpp"
#include "runtime/gl/state.hpp"
#include "runtime/passes/accumulation.hpp"
#include "runtime/passes/depth_probe.hpp"
#include "runtime/passes/filter_pass.hpp"
#include "runtime/renderer.hpp"
#include "runtime/splats/ordered_splats.hpp"
#include "runtime/splats/splat_target.hpp"
#include "scene/clip_range.hpp"

namespace tureen {

struct Renderer::State {
  State(const gl::Context& context, PreparedScene& prepared, const RenderOptions& options)
      : background(options.background),
        splat_format(options.splat_format),
        device(context.capabilities()),
        draws_layers(!prepared.make_passes) {
    layers = upload(prepared);
    plan = std::move(prepared.plan);
    arrange();
    if (prepared.make_passes) passes = prepared.make_passes(device, plan);
    if (!has_one_sample_a_pixel(plan.quality)) filter.emplace(plan.quality, device.api);
  }

  DeviceLayers upload(PreparedScene& prepared) const;
  bool has_splats() const;
  /// Those on the device.
  std::vector<DeviceSplats*> splats() const;
  void arrange();
  void make_splat_pass();
  void drop_splat_pass();
  void upload_tiled_splats();
  void add(DeviceLayers added);
  FrameFormat format() const;

  /// Calls act(pass) for each pass in order, without the filter.
  template <class Act>
  void for_each_pass(const Act& act) {
    if (draws_layers) {
      for (const std::unique_ptr<DeviceLayer>& layer : layers)
        if (layer->passes.faces) act(*layer->passes.faces);
      for (const std::unique_ptr<DeviceLayer>& layer : layers)
        if (layer->passes.shading) act(*layer->passes.shading);
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

  glm::vec4 background;
  SplatFormat splat_format;
  gl::Capabilities device;
  FrameTarget target{{}};
  DeviceLayers layers;
  RenderPlan plan;           // arrange() gives it the plans of the layers
  bool layered = false;      // the passes are those of several soups
  bool draws_layers = true;  // otherwise `passes` are all passes
  std::unique_ptr<SplatSorter> splat_sorter;
  std::unique_ptr<SplatBlendingPass> splat_pass;  // of all layers of splats
  OrderedSplats* ordered_splats = nullptr;        // of the pass, if the device blends
  Passes passes;                                  // from outside
  std::optional<FilterPass> filter;               // for other than one sample per pixel
  glm::ivec2 size{0};                             // of the last image; 0 before the first
  Frame frame;                                    // the last one
  Camera camera;                                  // of the last frame, at the image's size
  gl::PassTimer* timer = nullptr;
  std::optional<DepthProbe> probe;
  std::optional<FrameInput> shown;   // of the last draw(), unless it has failed or is out of date
  std::optional<Accumulation> rest;  // made by refine()
  bool rest_refused = false;         // the device lacks the memory for it
  std::vector<LayerPlace> visible_boxes;  // for set_frame(), without names
};

}  // namespace tureen
