#include "jobs/visibility/visibility_count.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "oracle/hits.hpp"
#include "runtime/renderer.hpp"
#include "scene/lattice.hpp"
#include "scene/scene.hpp"

namespace tureen {

namespace {

/// Calls visit(view, faces) with the face of each pixel of each view.
template <class Visit>
void visit_images(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                  std::span<const Camera> views, const std::function<void(double)>& progress,
                  const Visit& visit) {
  // Forward plans do not store faces.
  Renderer renderer(context, prepare_scene(soup, origin, device_limits(context.capabilities()),
                                           {.plan = {.site = ShadingSite::deferred}}));
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (progress) progress(double(i) / double(views.size()));
    renderer.draw({views[i]});
    std::vector<std::uint32_t> faces;
    for (const VisibleFace& visible : renderer.read_faces()) faces.push_back(visible.face);
    visit(views[i], faces);
  }
}

}  // namespace

std::vector<std::uint64_t> count_visible_pixels(const gl::Context& context,
                                                const TriangleSoup& soup, glm::dvec3 origin,
                                                std::span<const Camera> views,
                                                const std::function<void(double)>& progress) {
  std::vector<std::uint64_t> pixels(soup.triangles.size(), 0);
  visit_images(context, soup, origin, views, progress,
               [&](const Camera&, const std::vector<std::uint32_t>& faces) {
                 for (const std::uint32_t face : faces)
                   if (face != no_face) ++pixels[face];
               });
  return pixels;
}

std::vector<std::uint64_t> count_covered_pixels(const gl::Context& context,
                                                const TriangleSoup& soup, glm::dvec3 origin,
                                                std::span<const Camera> views,
                                                const std::function<void(double)>& progress) {
  std::vector<std::uint64_t> pixels;
  visit_images(context, soup, origin, views, progress,
               [&](const Camera&, const std::vector<std::uint32_t>& faces) {
                 const auto empty = std::count(faces.begin(), faces.end(), no_face);
                 pixels.push_back(faces.size() - std::size_t(empty));
               });
  return pixels;
}

std::vector<float> count_visible_texels(const gl::Context& context, const TriangleSoup& soup,
                                        glm::dvec3 origin, std::span<const Camera> views,
                                        const std::function<void(double)>& progress) {
  const auto& texture = std::get<LatticeTexture>(soup.appearance);
  // In floats, a sum of millions of small weights would stop growing.
  std::vector<double> shown(texture.texel_count(), 0.0);
  visit_images(context, soup, origin, views, progress,
               [&](const Camera& view, const std::vector<std::uint32_t>& faces) {
                 assert(faces.size() == std::size_t(view.width) * std::size_t(view.height));
                 const oracle::Rays rays(soup, at_origin(origin), view);
                 rays.visit_faces(0, view.height, [&](int column, int row, const oracle::Hit& hit) {
                   const std::size_t pixel =
                       std::size_t(row) * std::size_t(view.width) + std::size_t(column);
                   if (faces[pixel] != hit.face) return;
                   const LatticePatch& patch = texture.patches[hit.face];
                   const auto at = lattice::footprint(int(patch.level), hit.b0, hit.b1);
                   for (std::size_t k = 0; k < 3; ++k)
                     shown[patch.first_texel + at.texels[k]] += std::max(at.weights[k], 0.0);
                 });
               });
  return {shown.begin(), shown.end()};
}

std::vector<std::uint8_t> most_visible(std::span<const std::uint64_t> pixels, double fraction) {
  assert(fraction > 0 && fraction <= 1);
  std::vector<std::uint32_t> order(pixels.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return pixels[a] > pixels[b]; });
  const auto wanted = std::size_t(std::llround(fraction * double(pixels.size())));
  const std::size_t count = std::min(std::max<std::size_t>(wanted, 1), pixels.size());
  std::vector<std::uint8_t> keeps(pixels.size(), 0);
  for (std::size_t i = 0; i < count; ++i) keeps[order[i]] = 1;
  return keeps;
}

}  // namespace tureen
