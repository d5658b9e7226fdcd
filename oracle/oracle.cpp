#include "oracle/oracle.hpp"

#include <algorithm>
#include <cassert>
#include <glm/common.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <span>

#include "oracle/shade.hpp"

namespace tureen {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Rays in one band: their hits are kept until the band is shaded (about 32 MiB).
constexpr int rays_in_a_band = 1 << 20;

struct NearestHit {
  std::uint32_t face = OracleImage::no_face;
  std::uint32_t soup = 0;  // index in the list of visible soups
  double b0 = 0, b1 = 0;
  double depth = infinity;

  oracle::SurfacePoint point() const { return {face, b0, b1}; }
};

/// The colours of rays [first, first + colors.size()), 0 without a face.
struct RayColors {
  std::size_t first = 0;
  std::vector<glm::dvec3> colors;
};

/// The mean over a pixel's rays. `blended` is empty without splats.
glm::dvec4 pixel_of(const OracleImage& image, const RayColors& opaque,
                    std::span<const oracle::BlendedSample> blended, int column, int row,
                    const OracleOptions& options) {
  const int n = options.supersampling;
  const std::size_t stride = std::size_t(image.color.width) * n;
  glm::dvec3 sum(0.0);
  double covered = 0;  // rays
  for (int i = 0; i < n * n; ++i) {
    const std::size_t ray = (row * n + i / n) * stride + (column * n + i % n);
    const bool has_face = image.face[ray] != OracleImage::no_face;
    const double transmittance = blended.empty() ? 1.0 : blended[ray].transmittance;
    if (!blended.empty()) sum += blended[ray].color;
    if (has_face) sum += transmittance * opaque.colors[ray - opaque.first];
    covered += has_face ? 1.0 : 1.0 - transmittance;
  }
  const double coverage = covered / (n * n);
  glm::dvec4 pixel(0.0);
  if (options.background)
    pixel = {sum / double(n * n) + (1 - coverage) * glm::dvec3(*options.background), 1.0};
  else if (covered > 0)
    pixel = {sum / covered, coverage};
  return glm::clamp(pixel, 0.0, 1.0);
}

OracleImage render_layers(std::span<const PlacedLayer> layers, const FrameInput& input,
                          const OracleOptions& options) {
  struct VisibleSoup {
    const TriangleSoup& soup;
    std::uint32_t layer;
  };
  std::vector<VisibleSoup> soups;
  std::vector<PlacedLayer> splats;
  std::vector<LayerPlace> places;  // of all visible layers
  for (std::uint32_t i = 0; i < layers.size(); ++i) {
    const PlacedLayer& layer = layers[i];
    if (!layer.place.visible) continue;
    if (layer.soup)
      soups.push_back({*layer.soup, i});
    else
      splats.push_back(layer);
    places.push_back({bounds(layer), layer.place.world_from_layer});
  }
  const Camera& camera = input.camera;
  const int n = options.supersampling;
  assert(n >= 1);
  const Camera fine = n == 1 ? camera : resized(camera, camera.width * n, camera.height * n);
  const std::size_t stride = fine.width;
  const std::size_t all_rays = stride * fine.height;
  const bool has_splats = !splats.empty();

  const ClipRange range = clip_range(places, fine, DepthStorage::reversed_float);
  std::vector<oracle::Rays> rays;
  for (const auto& [soup, layer] : soups)
    rays.emplace_back(soup, layers[layer].place.world_from_layer, fine, options.rays, range);

  OracleImage result;
  result.color = ImageF(camera.width, camera.height);
  result.face.assign(all_rays, OracleImage::no_face);
  result.layer.assign(all_rays, 0);
  result.depth.assign(all_rays, infinity);

  const auto resolve = [&](int first_row, int end_row, const RayColors& opaque,
                           std::span<const oracle::BlendedSample> blended) {
    for (int row = first_row; row < end_row; ++row)
      for (int column = 0; column < camera.width; ++column)
        result.color.at(column, row) =
            glm::vec4(pixel_of(result, opaque, blended, column, row, options));
  };

  // Splats need the opaque depth of a ray before its pixel is known, so then all colours are kept.
  RayColors opaque;
  if (has_splats) opaque.colors.assign(all_rays, glm::dvec3(0.0));
  const int band_rows = n * std::max(1, rays_in_a_band / (fine.width * n));
  std::vector<NearestHit> nearest;
  for (int first = 0; first < fine.height; first += band_rows) {
    const int end = std::min(first + band_rows, fine.height);
    nearest.assign(stride * (end - first), {});
    // Layers come in order, and the faces of each by increasing index, so the strict comparison
    // resolves ties to the earlier layer and to the lower index.
    for (std::uint32_t i = 0; i < soups.size(); ++i)
      rays[i].visit_faces(first, end, [&](int column, int row, const oracle::Hit& hit) {
        NearestHit& best = nearest[(row - first) * stride + column];
        if (hit.depth < best.depth && oracle::is_visible(soups[i].soup, {hit.face, hit.b0, hit.b1}))
          best = {hit.face, i, hit.b0, hit.b1, hit.depth};
      });

    if (!has_splats) opaque = {first * stride, std::vector(nearest.size(), glm::dvec3(0.0))};
    for (int y = first; y < end; ++y)
      for (int x = 0; x < fine.width; ++x) {
        const NearestHit& hit = nearest[(y - first) * stride + x];
        if (hit.face == OracleImage::no_face) continue;
        const std::size_t ray = y * stride + x;
        const VisibleSoup& shown = soups[hit.soup];
        const oracle::Rays& its_rays = rays[hit.soup];
        result.face[ray] = hit.face;
        result.layer[ray] = shown.layer;
        result.depth[ray] = hit.depth;
        opaque.colors[ray - opaque.first] =
            oracle::color(shown.soup, hit.point(), its_rays.to_eye(x, y), its_rays.eye());
      }
    if (!has_splats) resolve(first / n, end / n, opaque, {});
    // With splats, opaque surfaces count as half of the work.
    if (options.progress) options.progress(double(end) / fine.height * (has_splats ? 0.5 : 1.0));
  }
  if (!has_splats) return result;

  oracle::SplatBlending blending{.order = options.splat_order,
                                 .stop = options.splat_stop,
                                 .supersampling = n,
                                 .near = range.near,
                                 .culls = options.splat_culls,
                                 .whole = input.whole};
  if (options.progress)
    blending.progress = [&](double fraction) { options.progress(0.5 + 0.5 * fraction); };
  const std::vector<oracle::BlendedSample> blended =
      oracle::blend(splats, camera, result.depth, blending);
  for (const oracle::BlendedSample& each : blended) {
    result.splat_alpha.push_back(1 - each.transmittance);
    result.splat_depth.push_back(each.median_depth);
  }
  resolve(0, camera.height, opaque, blended);
  if (options.progress) options.progress(1.0);
  return result;
}

}  // namespace

OracleImage render_oracle(const Scene& scene, const FrameInput& input,
                          const OracleOptions& options) {
  return render_layers(placed_layers(scene), input, options);
}

OracleImage render_oracle(const TriangleSoup& soup, glm::dvec3 origin, const FrameInput& input,
                          const OracleOptions& options) {
  const PlacedLayer layer = placed_layer(soup, origin);
  return render_layers(std::span(&layer, 1), input, options);
}

}  // namespace tureen
