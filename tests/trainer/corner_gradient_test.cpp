// The corners' gradient in vectors against its kernels, edge by edge, for triangles in front of,
// behind and through each other.
#include "trainer/diffsoup/cpu/corner_gradient.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/triangle_soup.hpp"
#include "tests/support/random.hpp"
#include "tests/trainer/stages.hpp"
#include "trainer/common/kernels/edge_gradient.hpp"

namespace tureen::trainer {
namespace corner_gradient_test {

using tureen::test::Random;

kernels::EdgePixel edge_pixel(const BatchImage& image, std::size_t pixel) {
  kernels::EdgePixel result{
      .face = image.visible[pixel].face,
      .inverse_depth = image.visible[pixel].inverse_depth,
      .color = {},
      .gradient = {},
  };
  for (std::size_t c = 0; c < 3; ++c) {
    result.color[c] = image.color[c * image.pixels() + pixel];
    result.gradient[c] = image.by_color[c * image.pixels() + pixel];
  }
  return result;
}

struct Expected {
  double corners[3][3] = {}, magnitude = 0;
  double error = 0;
};

/// The gradient of a face, from all four edges of each of its pixels.
Expected expected(const BatchImage& image, std::uint32_t face, float slide) {
  Expected result;
  const int width = image.view.width, height = image.view.height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = [&](int column, int row) {
        return std::size_t(row) * std::size_t(width) + std::size_t(column);
      };
      const kernels::EdgePixel p = edge_pixel(image, at(x, y));
      if (p.face != face) continue;
      result.error += double(image.loss[at(x, y)]);
      for (const auto& [dx, dy] : {std::pair(-1, 0), {1, 0}, {0, -1}, {0, 1}}) {
        const int qx = x + dx, qy = y + dy;
        if (qx < 0 || qy < 0 || qx >= width || qy >= height) continue;
        const kernels::EdgePixel q = edge_pixel(image, at(qx, qy));
        const bool background = q.face == no_face;
        const kernels::PointGradient point = kernels::edge_gradient(
            image.projected[face], background ? nullptr : &image.projected[q.face], x, y, qx, qy, p,
            q, background, slide);
        float corners[3][3] = {};
        if (point.kind != kernels::EdgeCase::none)
          kernels::distribute(image.view, image.projected[face], point, corners);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            result.corners[i][j] += double(corners[i][j]);
            result.magnitude += std::abs(double(corners[i][j]));
          }
      }
    }
  return result;
}

TEST(CornerGradient, IsTheSumOfTheEdges) {
  constexpr std::uint64_t seed = 5;
  SCOPED_TRACE(seed);
  Random random(seed);
  std::vector<glm::vec3> positions;
  for (int face = 0; face < 60; ++face) {
    const glm::vec3 center(random.normal(), random.normal(), -4.0 + 0.3 * random.normal());
    for (int k = 0; k < 3; ++k)
      positions.push_back(center +
                          0.5f * glm::vec3(random.normal(), random.normal(), random.normal()));
  }
  const test::Faces faces(positions);
  // Tiles at the right and lower border are not full; the last column has one pixel.
  BatchImage image = test::make_image(test::axis_camera(97, 70, 60));
  faces.find(image, Masking::threshold);
  for (float& color : image.color) color = float(random.uniform());
  for (float& gradient : image.by_color) gradient = float(random.normal());
  for (float& loss : image.loss) loss = float(random.uniform());
  image.color[97 * 30 + 40] = std::numeric_limits<float>::quiet_NaN();
  constexpr float slide = 0.5f;
  std::vector<Expected> found(faces.model.faces());
  for (std::size_t tile = 0; tile < image.tiles(); ++tile)
    find_corner_gradients(image, tile, slide);
  for (std::size_t face = 0; face < found.size(); ++face)
    for (std::uint32_t i = image.tiles_begin[face]; i < image.tiles_begin[face + 1]; ++i) {
      const CornerGradient& part = image.corner_gradient[image.tiles_of_faces[i].entry];
      found[face].error += double(part.error);
      for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j) found[face].corners[k][j] += double(part.corners[k][j]);
    }
  int visible = 0;
  for (std::size_t face = 0; face < found.size(); ++face) {
    SCOPED_TRACE(face);
    const Expected want = expected(image, std::uint32_t(face), slide);
    visible += want.error > 0;
    // Thousands of roundings in another order; each is 6e-8 of one edge.
    EXPECT_NEAR(found[face].error, want.error, 1e-5 * want.error);
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(found[face].corners[k][j], want.corners[k][j], 1e-5 * want.magnitude)
            << "corner " << k << ", axis " << j;
  }
  EXPECT_GT(visible, 30);
}

}  // namespace corner_gradient_test
}  // namespace tureen::trainer
