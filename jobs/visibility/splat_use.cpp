#include "jobs/visibility/splat_use.hpp"

#include <cmath>
#include <numeric>

#include "runtime/passes/pass.hpp"
#include "scene/clip_range.hpp"

namespace tureen {

SplatUse splat_use(const Splats& splats, const glm::dmat4& world_from_layer,
                   std::span<const Camera> views, const std::function<void(double)>& progress) {
  std::vector<std::uint32_t> all(count(splats));
  std::iota(all.begin(), all.end(), 0u);
  const std::vector<std::uint32_t> drawn = splatting::without_nan(splats, all);
  const std::unique_ptr<splatting::Layer> layer = splatting::make_layer(
      splatting::layer_data(splats, splats.profile, drawn, splats.color.degree));
  splatting::TileRenderer renderer({});
  std::vector<double> weights(drawn.size());
  SplatUse use;
  const LayerPlace placed{bounds(splats), world_from_layer};
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ClipRange range = clip_range({&placed, 1}, views[i], DepthStorage::reversed_float);
    const FrameCamera camera = camera_in_layer(views[i], world_from_layer, range);
    use.views.push_back(
        renderer.add_weights({layer.get(),
                              splatting::image_view(camera.camera, camera.eye, camera.range.near,
                                                    splats.profile, camera.camera),
                              camera.scale},
                             weights));
    if (progress) progress(double(i + 1) / double(views.size()));
  }
  use.weights.resize(all.size());
  for (std::size_t i = 0; i < drawn.size(); ++i)
    use.weights[drawn[i]] = std::uint64_t(std::llround(1e6 * weights[i]));
  return use;
}

}  // namespace tureen
