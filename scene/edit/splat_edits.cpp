#include "scene/edit/splat_edits.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "scene/edit/opaque_windows.hpp"

namespace tureen {

namespace {

/// Keeps the elements of the splats that stay; each splat has `per_splat` of them.
template <class T>
void keep(std::vector<T>& values, std::size_t per_splat, std::span<const std::uint8_t> keeps) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < keeps.size(); ++i) {
    if (!keeps[i]) continue;
    for (std::size_t k = 0; k < per_splat; ++k) values[kept++] = values[per_splat * i + k];
  }
  values.resize(kept);
}

}  // namespace

void keep_splats(SplatKernel& kernel, std::span<const std::uint8_t> keeps) {
  for_each_column(kernel,
                  [&](const auto& column) { keep(column.values, column.per_splat, keeps); });
}

Splats keep_splats(Splats splats, std::span<const std::uint8_t> keeps) {
  assert(keeps.size() == count(splats));
  for_each_array(splats, [&](auto& values, std::size_t each) { keep(values, each, keeps); });
  return splats;
}

std::vector<std::uint8_t> nearly_opaque_windows(const Splats& splats) {
  std::vector<std::uint8_t> result(count(splats));
  if (const auto* windows = std::get_if<TriangleWindows>(&splats.kernel))
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = mean_coverage(double(windows->opacity[i]), double(windows->sigma[i])) >= 0.9;
  return result;
}

std::string describe(const SplatEdits& edits) {
  std::string text;
  if (!edits.keeps_splat.empty()) {
    const auto gone = std::count(edits.keeps_splat.begin(), edits.keeps_splat.end(), 0);
    text = std::to_string(std::ptrdiff_t(edits.keeps_splat.size()) - gone) + " of " +
           std::to_string(edits.keeps_splat.size()) + " splats";
  }
  if (edits.opaque_windows)
    text += std::string(text.empty() ? "" : ", ") + "nearly opaque windows as triangles";
  return text.empty() ? "none" : text;
}

Scene edited(Scene scene, const SplatEdits& edits) {
  Layer& layer = only_layer(scene);
  auto& splats = std::get<Splats>(layer.primitives);
  if (!edits.keeps_splat.empty()) splats = keep_splats(std::move(splats), edits.keeps_splat);
  if (!edits.opaque_windows) return scene;
  std::vector<std::uint8_t> opaque = nearly_opaque_windows(splats);
  const auto triangles = std::size_t(std::count(opaque.begin(), opaque.end(), 1));
  if (triangles == 0) return scene;
  OpaqueResult result = to_opaque(keep_splats(splats, opaque));
  if (triangles == opaque.size()) {
    layer.primitives = std::move(result.soup);
    return scene;
  }
  for (std::uint8_t& each : opaque) each = !each;
  splats = keep_splats(std::move(splats), opaque);
  Layer of_triangles{.name = layer.name.empty() ? "opaque" : layer.name + ", opaque",
                     .world_from_layer = layer.world_from_layer,
                     .visible = layer.visible,
                     .primitives = std::move(result.soup)};
  scene.layers.push_back(std::move(of_triangles));
  return scene;
}

}  // namespace tureen
