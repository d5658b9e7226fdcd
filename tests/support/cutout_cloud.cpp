#include "tests/support/cutout_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>
#include <string>

#include "scene/lattice.hpp"
#include "tests/support/random.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen::test {

namespace {

struct Recipe {
  double field_of_view;  // degrees
  double deviation;      // of a vertex from its triangle's centre, per coordinate
};

Recipe recipe(CloudCoverage coverage) {
  switch (coverage) {
    case CloudCoverage::third:
      return {40.0, 0.06};
    case CloudCoverage::forty_percent:
      return {36.0, 0.06};
    case CloudCoverage::all:
      return {11.0, 0.1};
  }
  return {};
}

void add_patch(Random& random, int level, std::vector<std::uint8_t>& texels) {
  double base[LatticeTexture::features], slope[LatticeTexture::features][2];
  for (int c = 0; c < LatticeTexture::features; ++c) {
    base[c] = random.uniform(0.2, 0.8);
    for (double& s : slope[c]) s = random.uniform(-0.4, 0.4);
  }
  const double fall = random.uniform(0.5, 1.8);
  const int n = lattice::resolution(level);
  for (std::uint32_t i = 0; i < lattice::texel_count(level); ++i) {
    const auto [x, y] = lattice::texel_coordinates(i);
    const double b0 = double(x) / n, b1 = double(y) / n;
    const auto rounded = [](double value) {
      return std::uint8_t(std::clamp(value, 0.0, 1.0) * 255.0 + 0.5);
    };
    for (int c = 0; c < LatticeTexture::features; ++c)
      texels.push_back(rounded(base[c] + slope[c][0] * b0 + slope[c][1] * b1));
    const double alpha = 1.2 - 3.0 * fall * std::hypot(b0 - 1.0 / 3, b1 - 1.0 / 3);
    const std::uint8_t byte = rounded(alpha);
    texels.push_back(alpha >= alpha_threshold ? std::max<std::uint8_t>(byte, 128)
                                              : std::min<std::uint8_t>(byte, 127));
  }
}

}  // namespace

Scene cutout_cloud(const CutoutCloudOptions& options) {
  Random random(options.seed);
  TriangleSoup soup;
  LatticeTexture texture;
  std::vector<std::uint8_t> texels;
  texels.reserve(std::size_t(options.triangles) * lattice::texel_count(options.level) *
                 LatticeTexture::channels);
  for (int t = 0; t < options.triangles; ++t) {
    const double radius = std::cbrt(random.uniform(0.2, 1.0));
    const glm::dvec3 center = radius * random.direction();
    for (int k = 0; k < 3; ++k) {
      glm::dvec3 offset;
      for (int c = 0; c < 3; ++c) offset[c] = recipe(options.coverage).deviation * random.normal();
      soup.positions.emplace_back(center + offset);
    }
    soup.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    texture.patches.push_back(
        {std::uint32_t(texels.size() / LatticeTexture::channels), std::uint32_t(options.level)});
    add_patch(random, options.level, texels);
  }
  texture.texels = std::move(texels);
  texture.mlp = random_lattice_mlp(random);
  soup.appearance = std::move(texture);

  Scene scene = scene_of(std::move(soup));
  scene.info.name = "cut-out cloud";
  scene.info.up = {0, 0, 1};
  scene.info.source = "generated";
  for (int i = 0; i < 8; ++i) {
    const double angle = i * glm::quarter_pi<double>();
    scene.cameras.push_back(look_at(
        {3.2 * std::cos(angle), 3.2 * std::sin(angle), 1.2}, glm::dvec3(0), {0, 0, 1},
        glm::radians(recipe(options.coverage).field_of_view), options.width, options.height));
    scene.cameras.back().name = "view " + std::to_string(i);
  }
  return scene;
}

}  // namespace tureen::test
