#include "oracle/oracle.hpp"

#include <algorithm>
#include <cassert>
#include <glm/vec4.hpp>
#include <limits>
#include <span>
#include <variant>

#include "oracle/shade.hpp"

namespace tureen {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Rays in one band: their hits are kept until the band is shaded (about 32 MiB).
constexpr int rays_in_a_band = 1 << 20;

struct PlacedSoup {
  const TriangleSoup* soup;
  glm::dmat4 world_from_layer;
  std::uint32_t layer;  // its index in the scene
};

struct NearestHit {
  std::uint32_t face = OracleImage::no_face;
  std::uint32_t soup = 0;  // index in the list of placed soups
  double b0 = 0, b1 = 0;
  double depth = infinity;

  oracle::SurfacePoint point() const { return {face, b0, b1}; }
};

OracleImage render_soups(std::span<const PlacedSoup> soups, const FrameInput& input,
                         const OracleOptions& options) {
  const Camera& camera = input.camera;
  const int n = options.supersampling;
  assert(n >= 1);
  const Camera fine = n == 1 ? camera : resized(camera, camera.width * n, camera.height * n);
  const std::size_t stride = fine.width;

  std::vector<PlacedBounds> placed;
  for (const PlacedSoup& each : soups)
    placed.push_back({bounds(*each.soup), each.world_from_layer});
  const ClipRange range = clip_range(placed, fine, DepthStorage::reversed_float);
  std::vector<oracle::Rays> rays;
  for (const PlacedSoup& each : soups)
    rays.emplace_back(*each.soup, each.world_from_layer, fine, options.rays, range);

  OracleImage result;
  result.color = ImageF(camera.width, camera.height);
  result.face.assign(stride * fine.height, OracleImage::no_face);
  result.layer.assign(stride * fine.height, 0);
  result.depth.assign(stride * fine.height, infinity);

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
        if (hit.depth < best.depth &&
            oracle::is_visible(*soups[i].soup, {hit.face, hit.b0, hit.b1}))
          best = {hit.face, i, hit.b0, hit.b1, hit.depth};
      });

    for (int row = first / n; row < end / n; ++row)
      for (int column = 0; column < camera.width; ++column) {
        glm::dvec3 sum(0.0);
        int covered = 0;
        for (int i = 0; i < n * n; ++i) {
          const int x = column * n + i % n, y = row * n + i / n;
          const NearestHit& hit = nearest[(y - first) * stride + x];
          if (hit.face == OracleImage::no_face) continue;
          const PlacedSoup& shown = soups[hit.soup];
          const oracle::Rays& its_rays = rays[hit.soup];
          result.face[y * stride + x] = hit.face;
          result.layer[y * stride + x] = shown.layer;
          result.depth[y * stride + x] = hit.depth;
          sum += oracle::color(*shown.soup, hit.point(), its_rays.to_eye(x, y), its_rays.eye());
          ++covered;
        }
        const double coverage = double(covered) / (n * n);
        glm::dvec4 pixel(0.0);
        if (options.background)
          pixel = {sum / double(n * n) + (1 - coverage) * glm::dvec3(*options.background), 1.0};
        else if (covered > 0)
          pixel = {sum / double(covered), coverage};
        result.color.at(column, row) = glm::vec4(pixel);
      }
    if (options.progress) options.progress(double(end) / fine.height);
  }
  return result;
}

}  // namespace

OracleImage render_oracle(const Scene& scene, const FrameInput& input,
                          const OracleOptions& options) {
  std::vector<PlacedSoup> soups;
  for (std::uint32_t i = 0; i < scene.layers.size(); ++i) {
    const Layer& layer = scene.layers[i];
    if (!layer.visible) continue;
    assert(std::holds_alternative<TriangleSoup>(layer.primitives));
    soups.push_back({&std::get<TriangleSoup>(layer.primitives), layer.world_from_layer, i});
  }
  return render_soups(soups, input, options);
}

OracleImage render_oracle(const TriangleSoup& soup, glm::dvec3 origin, const FrameInput& input,
                          const OracleOptions& options) {
  const PlacedSoup only{&soup, at_origin(origin), 0};
  return render_soups({&only, 1}, input, options);
}

}  // namespace tureen
