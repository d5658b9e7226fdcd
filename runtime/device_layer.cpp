#include "runtime/device_layer.hpp"

#include <utility>

#include "runtime/renderer.hpp"
#include "runtime/splats/splat_source.hpp"

namespace tureen {

DeviceLayer::DeviceLayer(const gl::Capabilities& device, PreparedLayer prepared,
                         std::shared_ptr<LayerPlan> layer_plan)
    : place(std::move(prepared.place)), plan(std::move(layer_plan)) {
  if (prepared.soup)
    soup.emplace(device, std::move(prepared.soup->appearance), prepared.soup->geometry,
                 std::get<SoupPlan>(*plan));
  if (prepared.splats)
    splats.emplace(device, std::move(*prepared.splats), std::get<SplatPlan>(*plan));
  if (prepared.tiled_splats)
    tiled_splats = {splatting::make_layer(std::move(*prepared.tiled_splats)),
                    std::get<SplatPlan>(*plan).profile};
}

void DeviceLayer::upload_tiled_splats(const gl::Capabilities& device) {
  if (splats || !tiled_splats) return;
  splats.emplace(
      device, prepare_splats(tiled_splats->splats->data(), TexelLayout::of(device_limits(device))),
      std::get<SplatPlan>(*plan));
  splats->set_layer(tiled_splats->layer);
}

std::size_t DeviceLayer::device_bytes() const {
  return soup ? soup->device_bytes() : splats ? splats->device_bytes() : 0;
}

void DeviceLayer::leave_context() {
  if (soup) soup->leave_context();
  if (splats) splats->leave_context();
}

}  // namespace tureen
