#include "cli/tradeoff/tradeoff_views.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "camera/camera_sets.hpp"
#include "camera/navigation.hpp"
#include "cli/options/values.hpp"

namespace tureen::cli {

namespace {

/// `count` of the scene's cameras at another size, evenly spaced. The first is half a step after
/// the scene's first camera, so that another `count` selects other cameras.
std::vector<Camera> own_cameras(const Scene& scene, std::size_t count, const Lens& lens) {
  const std::size_t all = scene.cameras.size(), taken = std::min(count, all);
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < taken; ++i)
    cameras.push_back(
        resized(scene.cameras[(2 * i + 1) * all / (2 * taken)], lens.width, lens.height));
  return cameras;
}

bool is_among(const Camera& camera, const std::vector<Camera>& cameras) {
  return std::any_of(cameras.begin(), cameras.end(), [&](const Camera& other) {
    return other.view_from_world == camera.view_from_world;
  });
}

/// Views from a hemisphere and from the scene's cameras, except the views of the judges.
std::vector<Camera> counting_views(const Scene& scene, const Lens& lens,
                                   const std::vector<Camera>& judges) {
  // Enough views to see every face that is large in some view; few enough to draw in seconds.
  constexpr int each = 64;
  std::vector<Camera> views = hemisphere(subject_of(scene), each, lens);
  const std::vector<Camera> own = own_cameras(scene, each, lens);
  views.insert(views.end(), own.begin(), own.end());
  std::erase_if(views, [&](const Camera& view) { return is_among(view, judges); });
  return views;
}

}  // namespace

TradeoffViews tradeoff_views(const BenchViewOptions& options, const DefaultViews& defaults,
                             const Scene& scene, const std::string& scene_path) {
  const ImageSize size = parse_size(options.sizes.front());
  const Lens lens{.width = size.width, .height = size.height};
  TradeoffViews views;
  BenchViewOptions sets = options;
  if (sets.cameras.empty()) {
    if (scene.cameras.empty()) {
      sets.cameras.push_back(fmt::format("hemisphere:{}", defaults.count));
    } else {
      views.judges = own_cameras(scene, std::size_t(defaults.count), lens);
      views.camera_set = fmt::format("scene:{}", views.judges.size());
    }
    if (defaults.adversarial) sets.cameras.push_back("adversarial");
  }
  if (!sets.cameras.empty()) {
    BenchViewList list = bench_views(sets, scene, scene_path);
    views.notes = std::move(list.notes);
    for (const BenchViews& each : list.views) {
      views.camera_set += (views.camera_set.empty() ? "" : ",") + each.camera_set;
      views.judges.insert(views.judges.end(), each.cameras.begin(), each.cameras.end());
    }
  }
  views.counting = counting_views(scene, lens, views.judges);
  return views;
}

}  // namespace tureen::cli
