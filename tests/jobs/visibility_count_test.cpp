// Counts of visible pixels and texels.
#include "jobs/visibility/visibility_count.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <numeric>

#include "image/metrics.hpp"
#include "scene/edit/keep_faces.hpp"
#include "scene/lattice.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen {
namespace visibility_count_test {

gl::Context& context() {
  static gl::Context shared = gl::Context::create({});
  shared.make_current();
  return shared;
}

std::vector<Camera> cameras(std::uint64_t seed, int count) {
  test::Random random(seed);
  std::vector<Camera> result;
  for (int i = 0; i < count; ++i) result.push_back(test::random_camera(random, 160, 120));
  return result;
}

TEST(VisibilityCount, IsThePixelsThatTheOracleNames) {
  SCOPED_TRACE("seed 801");
  const TriangleSoup soup = test::random_soup(801, {.kind = test::Kind::lattice});
  const auto views = cameras(801, 3);
  const auto counted = count_visible_pixels(context(), soup, glm::dvec3(0), views);
  std::vector<std::int64_t> expected(soup.triangles.size(), 0);
  for (const Camera& view : views)
    for (const std::uint32_t face : test::snapped_oracle(soup, glm::dvec3(0), view).face)
      if (face != no_face) ++expected[face];
  ASSERT_EQ(counted.size(), expected.size());
  std::int64_t difference = 0, total = 0;
  for (std::size_t t = 0; t < expected.size(); ++t) {
    difference += std::abs(std::int64_t(counted[t]) - expected[t]);
    total += expected[t];
  }
  EXPECT_GT(total, 1000);
  // The bound of tests/support/agreement.hpp, over all pixels, for ties of depth and threshold.
  EXPECT_LE(double(difference), 2e-4 * 3 * 160 * 120);
  EXPECT_EQ(counted, count_visible_pixels(context(), soup, glm::dvec3(0), views));
}

TEST(VisibilityCount, TexelsOfAFaceComeToItsPixels) {
  SCOPED_TRACE("seed 803");
  const TriangleSoup soup = test::random_soup(803, {.kind = test::Kind::lattice});
  const auto& texture = std::get<LatticeTexture>(soup.appearance);
  const auto views = cameras(803, 3);
  const auto pixels = count_visible_pixels(context(), soup, glm::dvec3(0), views);
  const auto texels = count_visible_texels(context(), soup, glm::dvec3(0), views);
  ASSERT_EQ(texels.size(), texture.texel_count());
  // By patch, because faces may share patches.
  std::map<std::uint32_t, std::pair<double, double>> patches;
  for (std::size_t t = 0; t < pixels.size(); ++t) {
    const LatticePatch& patch = texture.patches[t];
    auto& [expected, counted] = patches[patch.first_texel];
    expected += double(pixels[t]);
    counted = 0;
    for (std::uint32_t i = 0; i < lattice::texel_count(int(patch.level)); ++i)
      counted += double(texels[patch.first_texel + i]);
  }
  double total = 0, missing = 0;
  for (const auto& [first, counts] : patches) {
    // The weights of a pixel sum to one, up to the rounding of this many floats.
    EXPECT_LE(counts.second, counts.first * (1 + 1e-5)) << "patch at " << first;
    total += counts.first;
    missing += counts.first - counts.second;
  }
  EXPECT_GT(total, 1000);
  // Corners on a grid of 1/256 of a pixel move few edges across a centre.
  EXPECT_LE(missing, 2e-3 * total);
}

TEST(VisibilityCount, TexelsBehindOthersAreNotShown) {
  // Two faces of level 2, and a third in front of the second that hides a part of it.
  TriangleSoup soup;
  soup.positions = {{-2, 0, 0}, {-1, 0, 0},     {-2, 1, 0},     {0, 0, 0},    {1, 0, 0},
                    {0, 1, 0},  {-.5, -.5, .1}, {2.1, -.5, .1}, {-.5, .8, .1}};
  soup.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  LatticeTexture texture;
  texture.patches = {{0, 2}, {15, 2}, {30, 2}};
  texture.texels = std::vector<std::uint8_t>(45 * LatticeTexture::channels, 255);
  soup.appearance = std::move(texture);
  const Camera camera = look_at({0, 0.3, 50}, {0, 0.3, 0}, {0, 1, 0}, 0.06, 400, 300);
  const auto shown = count_visible_texels(context(), soup, glm::dvec3(0), std::array{camera});
  for (std::size_t i = 0; i < 15; ++i) EXPECT_GT(shown[i], 100.0f) << i;
  int hidden = 0;
  for (std::size_t i = 0; i < 15; ++i) {
    // Texel (x, y) of the second face is at world position (y/4, 1 - x/4 - y/4). The third face
    // hides the area below the line from (2.1, -.5) to (-.5, .8).
    const auto at = lattice::texel_coordinates(std::uint32_t(i));
    const double across = at.y / 4.0, up = 1 - at.x / 4.0 - at.y / 4.0;
    const double above = up - (0.55 - 0.5 * across);
    // A texel's weight extends over a quarter on each side: pixels there add to it.
    if (above > 0.05) {
      EXPECT_GT(shown[15 + i], 1.0f) << i;
    } else if (above < -0.26) {
      EXPECT_EQ(shown[15 + i], 0.0f) << i;
      ++hidden;
    }
  }
  EXPECT_EQ(hidden, 4);
}

TEST(VisibilityCount, FlatSoupsAreCountedToo) {
  SCOPED_TRACE("seed 802");
  const TriangleSoup soup = test::random_soup(802, {.kind = test::Kind::face_colors});
  const auto counted = count_visible_pixels(context(), soup, glm::dvec3(0), cameras(802, 1));
  EXPECT_GT(std::accumulate(counted.begin(), counted.end(), std::uint64_t(0)), 1000u);
}

TEST(VisibilityCount, TheMostVisibleAreKeptStably) {
  const std::vector<std::uint64_t> pixels = {5, 0, 9, 5, 1, 0};
  using Keeps = std::vector<std::uint8_t>;
  EXPECT_EQ(most_visible(pixels, 1.0), Keeps({1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(most_visible(pixels, 0.5), Keeps({1, 0, 1, 1, 0, 0}));
  EXPECT_EQ(most_visible(pixels, 0.33), Keeps({1, 0, 1, 0, 0, 0}));
  EXPECT_EQ(most_visible(pixels, 0.01), Keeps({0, 0, 1, 0, 0, 0}));
  EXPECT_EQ(most_visible(pixels, 0.84), Keeps({1, 1, 1, 1, 1, 0}));
  EXPECT_EQ(most_visible({}, 0.5), Keeps());
}

// Removing faces that no view shows changes no view.
TEST(VisibilityCount, OmittingWhatIsNotSeenChangesNothing) {
  SCOPED_TRACE("seed 803");
  const TriangleSoup soup = test::random_soup(803, {.kind = test::Kind::lattice_mlp});
  const auto views = cameras(803, 2);
  const auto pixels = count_visible_pixels(context(), soup, glm::dvec3(0), views);
  std::size_t seen = 0;
  for (const std::uint64_t count : pixels) seen += count > 0 ? 1 : 0;
  ASSERT_LT(seen, pixels.size());
  const TriangleSoup fewer =
      keep_faces(soup, most_visible(pixels, double(seen) / double(pixels.size())));
  EXPECT_EQ(fewer.triangles.size(), seen);
  for (const Camera& view : views) {
    const auto all = test::draw(context(), soup, glm::dvec3(0), view);
    const auto some = test::draw(context(), fewer, glm::dvec3(0), view);
    // The clusters differ, the images do not.
    EXPECT_TRUE(all.color.pixels == some.color.pixels);
  }
}

}  // namespace visibility_count_test
}  // namespace tureen
