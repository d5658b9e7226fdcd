// Splats of tests of numerics, drawn by the renderer in tiles on the processor.
#pragma once

#include <cstring>
#include <numeric>
#include <vector>

#include "scene/clip_range.hpp"
#include "splatting/tile_renderer.hpp"
#include "tests/numerics/splat_scenes.hpp"

namespace tureen::test {

/// As blended_by_device(), for a scene with one layer at the origin that make_layer() supports.
inline std::vector<glm::vec4> blended_by_tiles(const Scene& scene, const Camera& camera) {
  const auto& splats = std::get<Splats>(scene.layers[0].primitives);
  std::vector<std::uint32_t> all(count(splats));
  std::iota(all.begin(), all.end(), 0u);
  const auto layer = splatting::make_layer(splats, all, splats.color.degree);
  const PlacedBounds box{.bounds = bounds(splats)};
  const double near = clip_range(std::span(&box, 1), camera, DepthStorage::reversed_float).near;
  const splatting::LayerInView view{
      layer.get(), splatting::image_view(camera, camera.eye(), near, splats.profile, camera), 1.0};
  std::vector<glm::vec4> rgba(std::size_t(camera.width) * std::size_t(camera.height));
  splatting::TileRenderer([](std::size_t jobs, const std::function<void(std::size_t)>& body) {
    for (std::size_t i = 0; i < jobs; ++i) body(i);
  }).draw(std::span(&view, 1), {}, {&rgba[0][0], 4 * rgba.size()});
  return rgba;
}

/// The largest difference of alpha, of the device and of the tiles, from these.
inline double alpha_error_of_both(const Scene& scene, const Camera& camera,
                                  const std::vector<double>& expected) {
  double error = alpha_error(scene, camera, expected);
  const std::vector<glm::vec4> blended = blended_by_tiles(scene, camera);
  for (std::size_t i = 0; i < blended.size(); ++i)
    error = worse(error, std::abs(double(blended[i].a) - expected[i]));
  return error;
}

}  // namespace tureen::test
