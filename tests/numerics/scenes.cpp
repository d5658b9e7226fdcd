#include "tests/numerics/scenes.hpp"

#include <algorithm>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "oracle/oracle.hpp"
#include "oracle/shade.hpp"
#include "scene/scene.hpp"
#include "tests/support/contexts.hpp"
#include "tests/trainer/stages.hpp"

namespace tureen::test {

gl::Context& shared_context() {
  static gl::Context context = gl::Context::create(osmesa);
  context.make_current();
  return context;
}

TriangleSoup soup_of(std::vector<glm::vec3> corners) {
  TriangleSoup soup;
  soup.positions = std::move(corners);
  FaceColors colors;
  for (std::uint32_t v = 0; v + 2 < soup.positions.size(); v += 3) {
    soup.triangles.emplace_back(v, v + 1, v + 2);
    // Arbitrary 8-bit channels that differ from face to face.
    const std::uint32_t t = v / 3 + 1;
    colors.rgba.emplace_back(float(t * 97 % 256) / 255, float(t * 57 % 256) / 255,
                             float(t * 31 % 256) / 255, 1);
  }
  soup.appearance = std::move(colors);
  return soup;
}

Camera straight_camera(int width, int height, double focal) {
  return trainer::test::axis_camera(width, height, focal);
}

std::vector<std::uint32_t> faces_of_oracle(const TriangleSoup& soup, const Camera& camera,
                                           oracle::Coverage coverage) {
  return render_oracle(soup, glm::dvec3(0), {camera}, {.rays = {.coverage = coverage}}).face;
}

std::vector<std::uint32_t> faces_of_device(const TriangleSoup& soup, const Camera& camera,
                                           bool reversed_depth) {
  return draw(shared_context(), soup, glm::dvec3(0), camera,
              {.reversed_depth = reversed_depth, .site = ShadingSite::deferred})
      .faces;
}

std::vector<std::uint32_t> faces_of_trainer(const TriangleSoup& soup, const Camera& camera,
                                            double near, double far) {
  std::vector<glm::vec3> corners;
  for (const glm::uvec3& triangle : soup.triangles)
    for (int k = 0; k < 3; ++k) corners.push_back(soup.positions[triangle[k]]);
  const trainer::test::Faces faces(std::move(corners));
  trainer::BatchImage image = trainer::test::make_image(camera, near, far);
  faces.find(image, trainer::Masking::threshold);
  std::vector<std::uint32_t> result;
  for (const trainer::VisiblePixel& pixel : image.visible) result.push_back(pixel.face);
  return result;
}

double shown_pixels(const std::vector<std::uint32_t>& faces) {
  return double(faces.size()) - double(std::count(faces.begin(), faces.end(), no_face));
}

double differing(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  return double(std::inner_product(a.begin(), a.end(), b.begin(), std::size_t(0), std::plus<>(),
                                   std::not_equal_to<>()));
}

double differing_away_from_edges(const std::vector<std::uint32_t>& reference,
                                 const std::vector<std::uint32_t>& other, int width, int height) {
  const auto at_edge = [&](int x, int y) {
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v)
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u)
        if (reference[std::size_t(v) * width + u] != reference[std::size_t(y) * width + x])
          return true;
    return false;
  };
  double count = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t i = std::size_t(y) * width + x;
      count += reference[i] != other[i] && !at_edge(x, y);
    }
  return count;
}

double most_of(double mean) {
  // For a large mean, Poisson's distribution is close to a normal distribution.
  if (mean > 100) return std::floor(mean + 4 * std::sqrt(mean));
  double probability = std::exp(-mean), beyond = -std::expm1(-mean);
  double count = 0;
  while (beyond > 1.0 / 16'000) {
    probability *= mean / ++count;
    beyond -= probability;
  }
  return count;
}

std::array<glm::dvec3, 3> homogeneous_corners(const TriangleSoup& soup, const glm::dvec3& origin,
                                              const Camera& camera, std::uint32_t face) {
  std::array<glm::dvec3, 3> corners;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 position(soup.positions[soup.triangles[face][k]]);
    const glm::dvec3 view = camera.view_from_world * glm::dvec4(origin + position, 1);
    corners[std::size_t(k)] = {camera.fx * view.x - camera.cx * view.z,
                               -camera.cy * view.z - camera.fy * view.y, -view.z};
  }
  return corners;
}

namespace {

/// Weights of vertices 0 and 1 at a point of the image.
glm::dvec2 barycentrics(const std::array<glm::dvec3, 3>& corners, const glm::dvec2& place) {
  glm::dvec3 e;
  for (int k = 0; k < 3; ++k)
    e[k] = glm::dot(glm::cross(corners[std::size_t(k + 1) % 3], corners[std::size_t(k + 2) % 3]),
                    glm::dvec3(place, 1));
  return glm::dvec2(e) / (e.x + e.y + e.z);
}

/// The distance in pixels along x and y that roundings move a face in an image, at a depth. A
/// corner minus the eye is multiplied by the focal length, and its depth by the principal point.
/// Roundings scale with these products, even where their sum is small; roundings of w scale with
/// the position in the image. All are seen at that depth. An interpolated value is a0 + x dx + y
/// dy, and a0 is computed the same way: four products and four sums, each rounded relative to the
/// value's change across the image.
glm::dvec2 moved_at(const Camera& camera, const std::array<glm::dvec3, 3>& corners, double depth) {
  const glm::dvec2 focal(camera.fx, camera.fy), middle(camera.cx, camera.cy),
      size(camera.width, camera.height);
  double distance = 0, w = 0;  // the largest of a corner
  for (const glm::dvec3& v : corners) {
    const glm::dvec2 view = (glm::dvec2(v) - middle * v.z) / focal;
    distance = std::max(distance, glm::length(glm::dvec3(view, v.z)));
    w = std::max(w, std::abs(v.z));
  }
  const glm::dvec2 terms = (distance * focal + w * glm::max(glm::abs(middle), size)) / depth;
  return vertex_rounding(1) * terms + 8 * epsilon * size;
}

/// The largest change of each channel where barycentrics are off by up to `off`.
glm::dvec3 change_of_color(const TriangleSoup& soup, const oracle::SurfacePoint& point,
                           const glm::dvec2& off, const glm::dvec3& to_eye, const glm::dvec3& eye) {
  const glm::dvec3 color = oracle::color(soup, point, to_eye, eye);
  glm::dvec3 most(0);
  for (const double i : {-1, 0, 1})
    for (const double j : {-1, 0, 1}) {
      const oracle::SurfacePoint other{point.face, point.b0 + i * off.x, point.b1 + j * off.y};
      most = glm::max(most, glm::abs(oracle::color(soup, other, to_eye, eye) - color));
    }
  return most;
}

}  // namespace

ColorError color_error(const TriangleSoup& soup, const glm::dvec3& origin, const Camera& camera,
                       const OracleImage& expected, const Drawn& drawn) {
  // Harmonics of degree 3 have 16 terms with five roundings each (V5). A network's layer has as
  // many terms with two roundings. Colours are about 1; terms may be a few times larger.
  constexpr double of_colors = 16 * 5 * 4 * epsilon;
  const double half_step = 0.5 / 255;
  const oracle::Rays rays(soup, at_origin(origin), camera);
  ColorError result{.allowed = of_colors};
  std::size_t same = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(camera.width) + std::size_t(x);
      const std::uint32_t face = expected.face[i];
      if (face == no_face || drawn.faces[i] != face) continue;
      ++same;
      glm::dvec3 beyond;
      for (int c = 0; c < 3; ++c)
        beyond[c] =
            std::abs(double(expected.color.pixels[i][c]) - drawn.color.pixels[i][c] / 255.0) -
            half_step;
      if (std::max({beyond.x, beyond.y, beyond.z}) <= 0) continue;
      const auto corners = homogeneous_corners(soup, origin, camera, face);
      const glm::dvec2 place(x + 0.5, y + 0.5), b = barycentrics(corners, place);
      const glm::dvec2 moved = moved_at(camera, corners, expected.depth[i]);
      // Half a unit of the visibility buffer's 16 bits for each barycentric, and three roundings
      // for a quotient of interpolated values.
      glm::dvec2 off(0.5 / 65535 + 3 * epsilon);
      for (const glm::dvec2 axis : {glm::dvec2(moved.x, 0), glm::dvec2(0, moved.y)})
        off += glm::max(glm::abs(barycentrics(corners, place + axis) - b),
                        glm::abs(barycentrics(corners, place - axis) - b));
      const glm::dvec3 may =
          change_of_color(soup, {face, b.x, b.y}, off, rays.to_eye(x, y), camera.eye() - origin) +
          of_colors;
      for (int c = 0; c < 3; ++c)
        if (beyond[c] / may[c] > result.beyond / result.allowed) {
          result.beyond = beyond[c];
          result.allowed = may[c];
        }
    }
  result.compared = double(same) / double(expected.face.size());
  return result;
}

}  // namespace tureen::test
