#include "numerics/scenes.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

#include "runtime/oracle/oracle.hpp"
#include "support/agreement.hpp"
#include "support/contexts.hpp"
#include "trainer/stages.hpp"

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
    // Any eight bits a channel that differ from face to face.
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
  return render_oracle(soup, glm::dvec3(0), camera, {.rays = {.coverage = coverage}}).face;
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
  trainer::Picture picture = trainer::test::make_picture(camera, near, far);
  faces.find(picture, trainer::Masking::threshold);
  std::vector<std::uint32_t> result;
  for (const trainer::VisiblePixel& pixel : picture.visible) result.push_back(pixel.face);
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

}  // namespace tureen::test
