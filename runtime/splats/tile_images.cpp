#include "runtime/splats/tile_images.hpp"

#include <glm/common.hpp>
#include <numeric>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "runtime/passes/pass.hpp"

namespace tureen {

TileImages::TileImages(const Scene& scene, std::optional<glm::vec3> background,
                       splatting::BlendOrder order)
    : background_(background),
      order_(order),
      renderer_([this](std::size_t count, const std::function<void(std::size_t)>& body) {
        pool_.run(count, body);
      }) {
  for (const Layer& layer : scene.layers) {
    if (!layer.visible) continue;
    const auto* splats = std::get_if<Splats>(&layer.primitives);
    if (!splats) throw UsageError("tiles draw only splats, but the scene has triangles");
    if (!splatting::has_layer_for(*splats))
      throw UsageError("a layer has too many splats for tiles: " +
                       counted(count(*splats), "splat"));
    std::vector<std::uint32_t> all(count(*splats));
    std::iota(all.begin(), all.end(), 0u);
    layers_.push_back({splatting::make_layer(splatting::layer_data(*splats, splats->profile, all,
                                                                   splats->color.degree)),
                       &splats->profile,
                       {bounds(*splats), layer.world_from_layer}});
  }
}

std::optional<ImageF> TileImages::exact_image(const FrameInput& input) {
  const Camera& camera = input.camera;
  ImageF image(camera.width, camera.height, glm::vec4(background_.value_or(glm::vec3(0)), 0));
  std::vector<LayerPlace> places;
  for (const TiledLayer& layer : layers_) places.push_back(layer.place);
  const ClipRange range = clip_range(places, camera, DepthStorage::reversed_float);
  std::vector<splatting::LayerInView> views;
  for (const TiledLayer& layer : layers_) {
    const FrameCamera own = camera_in_layer(camera, layer.place.world_from_layer, range);
    views.push_back({layer.splats.get(),
                     splatting::image_view(own.camera, own.eye, own.range.near, *layer.profile,
                                           input.whole.value_or(camera)),
                     own.scale});
  }
  if (views.empty()) return image;
  renderer_.draw(
      views, {},
      [&](int first_row, std::span<const float> rgba) {
        glm::vec4* pixel = &image.at(0, first_row);
        for (std::size_t at = 0; at < rgba.size(); at += 4, ++pixel) {
          glm::vec3 color(rgba[at], rgba[at + 1], rgba[at + 2]);
          const float alpha = rgba[at + 3];
          if (background_)
            color += (1 - alpha) * *background_;
          else if (alpha > 0)
            color /= alpha;
          *pixel = glm::vec4(glm::clamp(color, 0.0f, 1.0f), alpha);
        }
      },
      order_);
  return image;
}

}  // namespace tureen
