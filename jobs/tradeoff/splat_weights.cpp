#include "jobs/tradeoff/splat_weights.hpp"

#include <cmath>
#include <numeric>

#include "runtime/passes/pass.hpp"
#include "scene/clip_range.hpp"
#include "splatting/tile_renderer.hpp"

namespace tureen::tradeoff {

std::vector<std::uint64_t> splat_weights(const Splats& splats, const glm::dmat4& world_from_layer,
                                         std::span<const Camera> views,
                                         const std::function<void(double)>& progress) {
  std::vector<std::uint32_t> all(count(splats));
  std::iota(all.begin(), all.end(), 0u);
  const std::unique_ptr<splatting::Layer> layer =
      splatting::make_layer(splats, splats.profile, all, splats.color.degree);
  splatting::TileRenderer renderer({});
  std::vector<double> weights(all.size());
  const PlacedBounds placed{bounds(splats), world_from_layer};
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ClipRange range = clip_range({&placed, 1}, views[i], DepthStorage::reversed_float);
    const FrameCamera camera = camera_in_layer(views[i], world_from_layer, range);
    renderer.add_weights({layer.get(),
                          splatting::image_view(camera.camera, camera.eye, camera.range.near,
                                                splats.profile, camera.camera),
                          camera.scale},
                         weights);
    if (progress) progress(double(i + 1) / double(views.size()));
  }
  std::vector<std::uint64_t> result;
  for (const double weight : weights) result.push_back(std::uint64_t(std::llround(1e6 * weight)));
  return result;
}

}  // namespace tureen::tradeoff
