// A layer on the device.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/passes/device_soup.hpp"
#include "runtime/passes/soup_passes.hpp"
#include "runtime/plan/plan.hpp"
#include "runtime/prepared_scene.hpp"
#include "runtime/splats/device_splats.hpp"
#include "runtime/splats/tile_pass.hpp"
#include "scene/layer_place.hpp"

namespace tureen {

/// A soup, splats on the device, or splats for TilePass. None of them for a layer that passes from
/// outside hold.
struct DeviceLayer {
  /// Uploads. Throws DeviceLimitError.
  DeviceLayer(const gl::Capabilities& device, PreparedLayer prepared,
              std::shared_ptr<LayerPlan> plan);
  DeviceLayer(const DeviceLayer&) = delete;
  DeviceLayer& operator=(const DeviceLayer&) = delete;

  bool has_splats() const { return splats || tiled_splats; }
  /// Uploads the splats that only tiles have needed so far, so that `splats` has them, too.
  void upload_tiled_splats(const gl::Capabilities& device);
  /// Bytes of buffers and textures; see Renderer::device_bytes().
  std::size_t device_bytes() const;
  /// See Renderer::leave_context(). Not that of the passes.
  void leave_context();

  LayerPlace place;
  const std::shared_ptr<LayerPlan> plan;  // `soup` refers to it
  std::optional<DeviceSoup> soup;         // the passes refer to it
  std::optional<DeviceSplats> splats;
  std::optional<TiledSplats> tiled_splats;
  SoupPasses passes;  // of a soup that the renderer draws
};

/// Layers stay in place: passes refer to them.
using DeviceLayers = std::vector<std::unique_ptr<DeviceLayer>>;

}  // namespace tureen
