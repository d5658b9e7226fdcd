// Stochastic masking: the draws, and the visibility stage that uses them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "scene/triangle_soup.hpp"
#include "tests/support/random.hpp"
#include "tests/trainer/fragments.hpp"
#include "tests/trainer/stages.hpp"
#include "trainer/common/kernels/random.hpp"

namespace tureen::trainer {
namespace visibility_draws_test {

using tureen::test::Random;

constexpr int image_width = 512;

// Draw number i along one of the inputs of a draw; all other inputs are fixed.
struct Sequence {
  std::string name;
  std::function<float(std::uint32_t)> draw;
};

std::vector<Sequence> sequences() {
  using kernels::draw_key;
  using kernels::uniform_draw;
  const std::uint32_t key = draw_key(7, 100, 3);
  return {
      {"Pixels", [=](std::uint32_t i) { return uniform_draw(key, i, 4711); }},
      {"Rows", [=](std::uint32_t i) { return uniform_draw(key, i * image_width, 4711); }},
      {"Faces", [=](std::uint32_t i) { return uniform_draw(key, 12345, i); }},
      {"Steps", [](std::uint32_t i) { return uniform_draw(draw_key(7, i, 3), 12345, 4711); }},
      {"Views", [](std::uint32_t i) { return uniform_draw(draw_key(7, 100, i), 12345, 4711); }},
      {"Seeds", [](std::uint32_t i) { return uniform_draw(draw_key(i, 100, 3), 12345, 4711); }},
      {"HighSeeds",
       [](std::uint32_t i) {
         return uniform_draw(draw_key(std::uint64_t(i) << 32, 100, 3), 12345, 4711);
       }},
      // Pixels and faces together, as in a step.
      {"PixelsOfFaces", [=](std::uint32_t i) { return uniform_draw(key, i >> 4, i & 15); }},
  };
}

class DrawsAlong : public testing::TestWithParam<Sequence> {};

TEST_P(DrawsAlong, AreAboveZeroAndAtMostOne) {
  for (std::uint32_t i = 0; i < 1u << 20; ++i) {
    const float u = GetParam().draw(i);
    ASSERT_GT(u, 0.0f);
    ASSERT_LE(u, 1.0f);
  }
}

TEST_P(DrawsAlong, AreUniform) {
  constexpr int bins = 256, count = 1 << 18;
  std::array<double, bins> found{};
  for (std::uint32_t i = 0; i < count; ++i)
    // (0, 1] in 256 half-open bins.
    ++found[std::size_t(std::ceil(GetParam().draw(i) * bins)) - 1];
  const double expected = double(count) / bins;
  double chi_squared = 0;
  for (const double n : found) chi_squared += (n - expected) * (n - expected) / expected;
  // Mean 255, variance 510: within five deviations. The bound is two-sided, because a sequence that
  // is too even is not random either.
  EXPECT_NEAR(chi_squared, 255, 5 * std::sqrt(510.0));
}

TEST_P(DrawsAlong, DoNotDependOnTheOnesBefore) {
  constexpr int bins = 16, count = 1 << 18;
  for (const std::uint32_t lag : {1u, 2u, 3u, 16u, 512u}) {
    std::array<double, bins * bins> found{};
    double correlation = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const double a = GetParam().draw(i), b = GetParam().draw(i + lag);
      correlation += 12 * (a - 0.5) * (b - 0.5) / count;
      ++found[std::size_t(std::ceil(a * bins) - 1) * bins + std::size_t(std::ceil(b * bins) - 1)];
    }
    double chi_squared = 0;
    constexpr double expected = double(count) / (bins * bins);
    for (const double n : found) chi_squared += (n - expected) * (n - expected) / expected;
    // The correlation's deviation is 1 / sqrt(count). Overlapping pairs make chi squared slightly
    // wider than with 255 degrees of freedom: six deviations.
    EXPECT_LT(std::abs(correlation), 5 / std::sqrt(double(count))) << "lag " << lag;
    EXPECT_NEAR(chi_squared, 255, 6 * std::sqrt(510.0)) << "lag " << lag;
  }
}

INSTANTIATE_TEST_SUITE_P(, DrawsAlong, testing::ValuesIn(sequences()),
                         [](const auto& tested) { return tested.param.name; });

// A stack of `faces` triangles that all cover the whole image, the first nearest.
std::vector<glm::vec3> stack(int faces) {
  std::vector<glm::vec3> positions;
  for (int face = 0; face < faces; ++face) {
    const float z = -2.0f - 0.1f * float(face);
    positions.insert(positions.end(), {{-20, -20, z}, {20, -20, z}, {0, 30, z}});
  }
  return positions;
}

float logit(double alpha) { return float(std::log(alpha / (1 - alpha))); }

TEST(StochasticVisibility, AnAlphaOfZeroNeverShowsAndOneAlways) {
  BatchImage image = test::make_image(test::axis_camera(512, 512, 256));
  test::Faces faces(stack(2));
  for (std::size_t i = 0; i < faces.store.alpha.size(); ++i)
    faces.store.alpha[i] = i < 3 ? 0.0f : 1.0f;
  for (std::uint32_t step = 0; step < 64; ++step) {  // 2^24 draws: each value about once
    image.draw_key = kernels::draw_key(1, step, 0);
    faces.find(image, Masking::stochastic);
    for (const VisiblePixel& pixel : image.visible) ASSERT_EQ(pixel.face, 1u);
  }
}

TEST(StochasticVisibility, FacesShowAsOftenAsTheirAlphasSay) {
  constexpr int faces_count = 3, steps = 16;
  const double alphas[faces_count] = {0.1, 0.5, 0.9};
  BatchImage image = test::make_image(test::axis_camera(256, 256, 128));
  test::Faces faces(stack(faces_count));
  for (std::size_t face = 0; face < faces_count; ++face)
    for (std::size_t texel = 0; texel < 3; ++texel)
      faces.model.logits[(face * 3 + texel) * channels + alpha_channel] = logit(alphas[face]);
  faces.refresh();
  double shown[faces_count + 1] = {};
  for (std::uint32_t step = 0; step < steps; ++step) {
    image.draw_key = kernels::draw_key(2, step, 0);
    faces.find(image, Masking::stochastic);
    for (const VisiblePixel& pixel : image.visible)
      ++shown[pixel.face == no_face ? faces_count : pixel.face];
  }
  const double count = steps * 256.0 * 256.0;
  double reached = 1;
  for (int face = 0; face <= faces_count; ++face) {
    const double p = face < faces_count ? reached * alphas[face] : reached;
    if (face < faces_count) reached *= 1 - alphas[face];
    EXPECT_NEAR(shown[face] / count, p, 4 * std::sqrt(p * (1 - p) / count)) << "face " << face;
  }
}

// Many faces, with varying alphas, in a random volume.
test::Faces random_faces(std::uint64_t seed, int count, int level = 2) {
  Random random(seed);
  std::vector<glm::vec3> positions;
  for (int face = 0; face < count; ++face) {
    const glm::dvec3 middle(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-6, -2));
    for (int k = 0; k < 3; ++k) positions.emplace_back(middle + 0.8 * random.direction());
  }
  test::Faces faces(positions, 0.0f, level);
  for (float& value : faces.model.logits) value = float(2 * random.normal());
  faces.refresh();
  return faces;
}

// A simple method: every face on every pixel, one after the other, without tiles.
std::vector<VisiblePixel> obvious(const test::Faces& faces, const BatchImage& image,
                                  Masking masking) {
  std::vector<VisiblePixel> visible(image.pixels());
  const std::size_t texels = faces.pyramid.fine_texels();
  for (std::uint32_t face = 0; face < faces.model.faces(); ++face)
    test::for_each_fragment(
        image.view, kernels::project(image.view, &faces.model.positions[3 * face].x),
        {0, 0, image.view.width, image.view.height}, [&](const kernels::Fragment& fragment) {
          const auto pixel =
              std::size_t(fragment.y) * std::size_t(image.view.width) + std::size_t(fragment.x);
          const auto at = lattice::footprint(faces.model.max_level, fragment.b0, fragment.b1);
          float alpha = 0;
          for (std::size_t j = 0; j < 3; ++j)
            alpha += at.weights[j] * faces.store.alpha[face * texels + at.texels[j]];
          const float needed =
              masking == Masking::threshold
                  ? alpha_threshold
                  : kernels::uniform_draw(image.draw_key, std::uint32_t(pixel), face);
          if (alpha >= needed && fragment.inverse_depth > visible[pixel].inverse_depth)
            visible[pixel] = {face, fragment.inverse_depth, fragment.b0, fragment.b1};
        });
  return visible;
}

TEST(StochasticVisibility, IsTheNearestAcceptedFragmentInAnyTile) {
  for (int trial = 0; trial < 2 * (lattice::max_level + 1); ++trial) {
    const Masking masking = trial % 2 ? Masking::threshold : Masking::stochastic;
    SCOPED_TRACE("level " + std::to_string(trial / 2));
    const test::Faces faces = random_faces(3, 300, trial / 2);
    BatchImage image = test::make_image(test::axis_camera(150, 110, 100));
    image.draw_key = kernels::draw_key(3, 1, 1);
    faces.find(image, masking);
    const std::vector<VisiblePixel> expected = obvious(faces, image, masking);
    int different = 0, covered = 0;
    for (std::size_t pixel = 0; pixel < expected.size(); ++pixel) {
      different += image.visible[pixel].face != expected[pixel].face;
      covered += expected[pixel].face != no_face;
      if (image.visible[pixel].face == expected[pixel].face) {
        ASSERT_NEAR(image.visible[pixel].b0, expected[pixel].b0, 1e-3);
      }
    }
    EXPECT_GT(covered, 5000);
    // The stage may be compiled with fused multiply-adds and this test without: a centre on an
    // edge, or an alpha within rounding of its draw, may differ.
    EXPECT_LE(different, 2);
  }
}

TEST(StochasticVisibility, DoesNotDependOnTheOrderOfTiles) {
  const test::Faces faces = random_faces(4, 300);
  BatchImage image = test::make_image(test::axis_camera(150, 110, 100));
  image.draw_key = kernels::draw_key(4, 1, 1);
  faces.find(image, Masking::stochastic);
  const auto first = image.visible;
  std::ranges::fill(image.visible, VisiblePixel{7, 1e9f, 7, 7});  // old content is overwritten
  for (std::size_t tile = image.bin_begin.size() - 1; tile-- > 0;)
    find_visible(image, tile, faces.store.alpha.data(), 2, Masking::stochastic);
  for (std::size_t pixel = 0; pixel < first.size(); ++pixel) {
    ASSERT_EQ(image.visible[pixel].face, first[pixel].face);
    ASSERT_EQ(image.visible[pixel].b0, first[pixel].b0);
    ASSERT_EQ(image.visible[pixel].inverse_depth, first[pixel].inverse_depth);
  }
}

TEST(Visibility, OfEqualDepthsTheLowerFaceShows) {
  // docs/numerics.md, G9: coincident faces, with tiles in any order.
  std::vector<glm::vec3> positions = stack(1);
  for (int copy = 0; copy < 2; ++copy)
    for (int k = 0; k < 3; ++k) positions.push_back(positions[std::size_t(k)]);
  const test::Faces faces(positions);
  BatchImage image = test::make_image(test::axis_camera(100, 70, 50));
  faces.find(image, Masking::threshold);
  for (const VisiblePixel& pixel : image.visible) ASSERT_EQ(pixel.face, 0u);
}

TEST(Visibility, FacesWithoutNumbersShowNothing) {
  std::vector<glm::vec3> positions = stack(2);
  positions[1].y = NAN;
  const test::Faces faces(positions);
  BatchImage image = test::make_image(test::axis_camera(100, 70, 50));
  faces.find(image, Masking::threshold);
  for (const VisiblePixel& pixel : image.visible) ASSERT_EQ(pixel.face, 1u);
}

}  // namespace visibility_draws_test
}  // namespace tureen::trainer
