#include "tests/bench/layered_soup.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>

#include "tests/support/random.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen::test {

namespace {

constexpr double field_of_view = glm::third<double>() * glm::pi<double>();
constexpr double aspect = 16.0 / 9;

/// Positions of all triangles, layer by layer from the front.
std::vector<glm::vec3> corners_of(const LayeredSoupOptions& options) {
  // Approximately square cells with two triangles each; the columns are rounded up.
  const double cells = double(options.triangles) / (2.0 * options.layers);
  const int rows = std::max(1, int(std::lround(std::sqrt(cells / aspect))));
  const int columns = std::max(1, int(std::ceil(cells / rows)));
  std::vector<glm::vec3> corners;
  for (int layer = 0; layer < options.layers; ++layer) {
    // Far enough apart for any depth buffer; farther layers are larger in proportion.
    const double depth = 2.0 + 0.05 * layer;
    const double half_height = layered_soup_fill * depth * std::tan(0.5 * field_of_view);
    const auto corner = [&](int row, int column) {
      return glm::vec3(half_height * aspect * (2.0 * column / columns - 1),
                       half_height * (2.0 * row / rows - 1), -depth);
    };
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const glm::vec3 a = corner(row, column), b = corner(row, column + 1),
                        c = corner(row + 1, column + 1), d = corner(row + 1, column);
        corners.insert(corners.end(), {a, b, c, a, c, d});
      }
  }
  return corners;
}

LatticeTexture cut_outs(Random& random, std::size_t faces) {
  constexpr std::uint32_t level = 1, texels_a_face = 6;
  LatticeTexture texture;
  std::vector<std::uint8_t> texels;
  texels.reserve(faces * texels_a_face * LatticeTexture::channels);
  for (std::size_t face = 0; face < faces; ++face) {
    texture.patches.push_back({std::uint32_t(face * texels_a_face), level});
    for (std::size_t i = 0; i < texels_a_face * LatticeTexture::channels; ++i)
      texels.push_back(std::uint8_t(random.uniform(0, 255.999)));
  }
  texture.texels = std::move(texels);
  texture.mlp = random_lattice_mlp(random);
  return texture;
}

}  // namespace

Scene layered_soup(const LayeredSoupOptions& options) {
  Random random(options.seed);
  const std::vector<glm::vec3> corners = corners_of(options);
  const std::size_t faces = corners.size() / 3;
  std::vector<std::size_t> order(faces);
  std::iota(order.begin(), order.end(), std::size_t(0));
  for (std::size_t i = faces; i > 1; --i)
    std::swap(order[i - 1], order[random.below(std::uint32_t(i))]);
  TriangleSoup soup;
  soup.positions.reserve(corners.size());
  soup.triangles.reserve(faces);
  for (const std::size_t face : order) {
    const auto first = std::uint32_t(soup.positions.size());
    for (std::size_t k = 0; k < 3; ++k) soup.positions.push_back(corners[3 * face + k]);
    soup.triangles.emplace_back(first, first + 1, first + 2);
  }
  if (options.kind == LayeredSoupOptions::Kind::cut_out) {
    soup.appearance = cut_outs(random, faces);
  } else {
    FaceColors colors;
    for (std::size_t face = 0; face < faces; ++face)
      colors.rgba.emplace_back(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1), 1);
    soup.appearance = std::move(colors);
  }
  Scene scene = scene_of(std::move(soup));
  scene.info.name = "layers";
  scene.info.source = "generated";
  scene.cameras.push_back(look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, field_of_view, 1280, 720));
  return scene;
}

}  // namespace tureen::test
