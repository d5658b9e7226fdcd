#include "oracle/oracle.hpp"

#include <algorithm>
#include <cassert>
#include <glm/vec4.hpp>
#include <limits>

#include "oracle/shade.hpp"
#include "scene/scene.hpp"

namespace tureen {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Rays in one band: their hits are kept until the band is shaded (about 32 MiB).
constexpr int rays_in_a_band = 1 << 20;

}  // namespace

OracleImage render_oracle(const TriangleSoup& soup, glm::dvec3 origin, const FrameInput& input,
                          const OracleOptions& options) {
  const Camera& camera = input.camera;
  const int n = options.supersampling;
  assert(n >= 1);
  const Camera fine = n == 1 ? camera : resized(camera, camera.width * n, camera.height * n);
  const oracle::Rays rays(soup, at_origin(origin), fine, options.rays);
  const glm::dvec3 eye = camera.eye() - origin;
  const std::size_t stride = fine.width;

  OracleImage result;
  result.color = ImageF(camera.width, camera.height);
  result.face.assign(stride * fine.height, OracleImage::no_face);
  result.depth.assign(stride * fine.height, infinity);

  const int band_rows = n * std::max(1, rays_in_a_band / (fine.width * n));
  std::vector<oracle::Hit> nearest;
  for (int first = 0; first < fine.height; first += band_rows) {
    const int end = std::min(first + band_rows, fine.height);
    nearest.assign(stride * (end - first), {OracleImage::no_face, 0, 0, infinity});
    // Faces come in increasing order, so the strict comparison resolves ties to the lower index.
    rays.visit_faces(first, end, [&](int column, int row, const oracle::Hit& hit) {
      oracle::Hit& best = nearest[(row - first) * stride + column];
      if (hit.depth < best.depth && oracle::is_visible(soup, {hit.face, hit.b0, hit.b1}))
        best = hit;
    });

    for (int row = first / n; row < end / n; ++row)
      for (int column = 0; column < camera.width; ++column) {
        glm::dvec3 sum(0.0);
        int covered = 0;
        for (int i = 0; i < n * n; ++i) {
          const int x = column * n + i % n, y = row * n + i / n;
          const oracle::Hit& hit = nearest[(y - first) * stride + x];
          result.face[y * stride + x] = hit.face;
          result.depth[y * stride + x] = hit.depth;
          if (hit.face == OracleImage::no_face) continue;
          sum += oracle::color(soup, {hit.face, hit.b0, hit.b1}, rays.to_eye(x, y), eye);
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

}  // namespace tureen
