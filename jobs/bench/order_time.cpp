#include "jobs/bench/order_time.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <vector>

#include "base/steady_seconds.hpp"
#include "jobs/baseline/splat_baseline_order.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/splats/ordered_splats.hpp"

namespace tureen {

std::optional<double> order_ms(const Scene& scene, PipelineKind pipeline,
                               std::span<const Camera> cameras,
                               const std::function<double()>& clock) {
  assert(!cameras.empty());
  struct Centers {
    std::vector<glm::vec3> centers;
    const glm::dmat4& world_from_layer;
  };
  std::vector<Centers> layers;
  for (const Layer& layer : scene.layers)
    if (const auto* splats = std::get_if<Splats>(&layer.primitives)) {
      Centers& of_layer = layers.emplace_back(Centers{{}, layer.world_from_layer});
      for (std::size_t i = 0; i < count(*splats); ++i)
        of_layer.centers.push_back(center(*splats, i));
    }
  if (layers.empty()) return std::nullopt;
  const auto now = [&] { return clock ? clock() : steady_seconds(); };
  SplatOrder order;
  SplatBaselineOrder baseline;
  double seconds = 0;
  for (const Camera& camera : cameras) {
    std::vector<FrameCamera> in_layers;
    std::vector<SplatsInView> views;
    for (const Centers& layer : layers) {
      in_layers.push_back(camera_in_layer(camera, layer.world_from_layer, {}));
      views.push_back(in_view(layer.centers, in_layers.back()));
    }
    double best = std::numeric_limits<double>::infinity();
    for (int repeat = 0; repeat < 3; ++repeat) {
      const double start = now();
      if (pipeline == PipelineKind::tureen)
        order.sort(views);
      else
        baseline.sort(layers.front().centers, in_layers.front());
      best = std::min(best, now() - start);
    }
    seconds += best;
  }
  return 1000 * seconds / double(cameras.size());
}

}  // namespace tureen
