// Images assembled from tiles, compared with the same images drawn whole.
#include "runtime/image_tiles.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "base/error.hpp"
#include "oracle/oracle.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/renderer_of.hpp"
#include "tests/support/samples.hpp"

namespace tureen::test {
namespace image_tiles_test {

/// The complete image.
Image8 draw_in_tiles(const FrameInput& input, const ImageTiles& tiles) {
  Image8 image(input.camera.width, input.camera.height);
  auto next = image.pixels.begin();
  draw_in_bands(input, tiles, [&](const Image8& rows) {
    next = std::copy(rows.pixels.begin(), rows.pixels.end(), next);
  });
  return image;
}

// -- cutting an image, without GL ---------------------------------------------------------------

/// For a camera at the origin with a focal length of 1, each pixel encodes the direction of its
/// ray, independent of tile borders.
Image8 image_of_rays(const Camera& camera) {
  Image8 image(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const int right = int(x - camera.cx), down = int(y - camera.cy);
      image.at(x, y) = glm::u8vec4(right & 255, right >> 8, down & 255, down >> 8);
    }
  return image;
}

Camera camera_of_rays(int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = 1;
  return camera;
}

TEST(ImageTiles, EveryPixelComesFromItsOwnRay) {
  for (const auto& [width, height] : {std::pair(1, 1), {64, 64}, {65, 129}, {333, 257}, {20000, 3}})
    for (const int side : {1, 37, 64, 100, 4096}) {
      const Camera camera = camera_of_rays(width, height);
      const Image8 image = draw_in_tiles(
          {camera}, {.draw = [](const FrameInput& input) { return image_of_rays(input.camera); },
                     .side = side,
                     .band_bytes = 1 << 20});
      EXPECT_EQ(image.pixels, image_of_rays(camera).pixels)
          << width << " x " << height << " in tiles of " << side;
    }
}

TEST(ImageTiles, TilesAndBandsStayWithinTheirBounds) {
  const Camera camera = camera_of_rays(1000, 501);
  std::vector<double> fractions;
  ImageTiles tiles{.side = 300, .band_bytes = 4000 * 130};
  tiles.draw = [&](const FrameInput& input) {
    const Camera& part = input.camera;
    EXPECT_LE(part.width, 300);
    EXPECT_LE(part.height, 130);
    // Tiles begin at multiples of 64 pixels from the lower left corner.
    const int below = camera.height - part.height + int(part.cy);
    EXPECT_EQ(below % 64, 0);
    EXPECT_EQ(int(-part.cx) % 64, 0);
    return image_of_rays(part);
  };
  tiles.progress = [&](double fraction) { fractions.push_back(fraction); };
  int rows = 0;
  draw_in_bands({camera}, tiles, [&](const Image8& band) {
    EXPECT_EQ(band.width, 1000);
    EXPECT_LE(band.pixels.size() * 4, tiles.band_bytes);
    rows += band.height;
  });
  EXPECT_EQ(rows, 501);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_DOUBLE_EQ(fractions.back(), 1.0);
  EXPECT_GT(fractions.front(), 0.0);
}

TEST(ImageTiles, ProgressMayAbandonTheImage) {
  int drawn = 0;
  ImageTiles tiles{.side = 64};
  tiles.draw = [&](const FrameInput& part) { return ++drawn, image_of_rays(part.camera); };
  tiles.progress = [](double fraction) {
    if (fraction > 0.4) throw std::runtime_error("enough");
  };
  EXPECT_THROW(draw_in_tiles({camera_of_rays(640, 64)}, tiles), std::runtime_error);
  EXPECT_EQ(drawn, 5);
}

// -- against the device -------------------------------------------------------------------------

class DrawnInTiles : public testing::TestWithParam<NamedContext> {};

/// Corners lie on whole pixels and faces are parallel to the image, so nothing is rounded, even
/// where a tile cuts a face. Every byte must be the same.
TEST_P(DrawnInTiles, NothingChangesWhereNothingIsRounded) {
  const gl::Context context = gl::Context::create(GetParam().request);
  Random random(3);
  TriangleSoup soup;
  FaceColors colors;
  for (std::uint32_t t = 0; t < 300; ++t) {
    const glm::vec2 corner(float(random.below(40)) / 8 - 2.5f, float(random.below(40)) / 8 - 2.5f);
    const float size = float(1 + random.below(12)) / 8;
    const float z = float(random.below(64)) / 512;  // 0 .. 1/8
    soup.positions.insert(soup.positions.end(),
                          {{corner, 0}, {corner + glm::vec2(size, 0), 0}, {corner + size, 0}});
    for (int k = 0; k < 3; ++k) {
      // The position in the image does not depend on the depth.
      glm::vec3& position = soup.positions[3 * t + std::uint32_t(k)];
      position = glm::vec3(glm::vec2(position) * (1 - z), z);
    }
    soup.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    colors.rgba.emplace_back(random.uniform(), random.uniform(), random.uniform(), 1);
  }
  soup.appearance = colors;
  Camera camera = look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 1, 256, 256);
  camera.fx = camera.fy = 64;  // an eighth of a unit is 8 pixels
  Renderer renderer = renderer_of(context, soup, {}, {.background = glm::vec4(0.0f)});
  renderer.draw({camera});
  const Image8 whole = renderer.read_color();
  for (const int side : {64, 128}) {
    ImageTiles tiles = tiles_of(renderer, context.capabilities());
    tiles.side = side;
    EXPECT_EQ(draw_in_tiles({camera}, tiles).pixels, whole.pixels) << side;
  }
}

class KindsInTiles : public testing::TestWithParam<InContext<Kind>> {};

/// Two effects change pixels. A different rounding of window coordinates, or clipping at a tile's
/// border, can snap a corner to the next 1/256 of a pixel and move an edge past a centre (any
/// difference). Different rounding of barycentrics changes a colour by one step. Over all
/// appearances, seeds 1 to 3, sides 37 to 128, and one or four samples per pixel, at most 17 of
/// 85,581 pixels were off by more than a step, 187 by any amount, and 9 in coverage; the means were
/// 6, 30 and 2. The bounds are twice the maxima.
TEST_P(KindsInTiles, LookAsTheyDoWhole) {
  const auto& [named, kind] = GetParam();
  const gl::Context context = gl::Context::create(named.request);
  for (const int supersampling : {1, 2}) {
    constexpr std::uint64_t seed = 2;
    const TriangleSoup soup =
        random_soup(seed, {.kind = kind, .faces = 300, .size = 0.2, .degenerate = true});
    RenderOptions options{.background = glm::vec4(0.0f)};
    options.plan.quality.supersampling = supersampling;
    Renderer renderer = renderer_of(context, soup, {}, options);
    Random random(seed);
    const Camera camera = random_camera(random, 333, 257);
    renderer.draw({camera});
    const Image8 whole = renderer.read_color();
    ImageTiles tiles = tiles_of(renderer, context.capabilities());
    tiles.side = 128;
    const Image8 image = draw_in_tiles({camera}, tiles);
    std::size_t off = 0, off_by_more = 0, coverage = 0, transparent = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const glm::ivec4 difference = abs(glm::ivec4(image.pixels[i]) - glm::ivec4(whole.pixels[i]));
      const int largest = std::max({difference.r, difference.g, difference.b, difference.a});
      off += largest > 0;
      off_by_more += largest > 1;
      coverage += difference.a > 0;
      transparent += image.pixels[i].a == 0;
      const bool straight = image.pixels[i].a == 0 || image.pixels[i].a == 255;
      ASSERT_TRUE(straight || supersampling > 1);
    }
    const std::string what = to_string(kind) + ", seed " + std::to_string(seed) + ", " +
                             std::to_string(supersampling) + " samples per axis";
    EXPECT_LE(off_by_more, 34u) << what;
    EXPECT_LE(off, 374u) << what;
    EXPECT_LE(coverage, 18u) << what;
    EXPECT_GT(transparent, image.pixels.size() / 10) << what;
    EXPECT_LT(transparent, image.pixels.size()) << what;
  }
}

INSTANTIATE_TEST_SUITE_P(All, DrawnInTiles, testing::ValuesIn(every_context), context_name);
INSTANTIATE_TEST_SUITE_P(, KindsInTiles, in_contexts(all_kinds), name_in_context);
INSTANTIATE_TEST_SUITE_P(Thorough, KindsInTiles, in_other_contexts(all_kinds), name_in_context);

/// An image wider than any device can draw, compared with the oracle, which has no limit.
TEST(ImageTiles, AnImageBeyondTheDeviceShowsWhatTheOracleSees) {
  const gl::Context context = gl::Context::create(osmesa);
  const int width = context.capabilities().max_image_side + 5000;
  const TriangleSoup soup = random_soup(4, {.kind = Kind::face_colors, .faces = 40, .size = 0.4});
  Random random(4);
  Camera camera = random_camera(random, 320, 240);
  // A strip through the middle.
  const double enlarged = double(width) / 320;
  camera.fx *= enlarged;
  camera.fy *= enlarged;
  camera.cx *= enlarged;
  camera.cy = 8;
  camera.width = width;
  camera.height = 16;
  Renderer renderer = renderer_of(context, soup, {});
  EXPECT_THROW(renderer.draw({camera}), DeviceLimitError);
  const Image8 image = draw_in_tiles({camera}, tiles_of(renderer, context.capabilities()));
  const Image8 expected = quantised(
      render_oracle(soup, {}, {camera}, {.rays = {.coverage = oracle::Coverage::snapped}}).color);
  std::size_t off = 0, covered = 0;
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    off += image.pixels[i] != expected.pixels[i];
    covered += expected.pixels[i] != glm::u8vec4(0, 0, 0, 255);
  }
  EXPECT_GT(covered, expected.pixels.size() / 20);
  // The difference is 0, also with seeds 5 to 15. The rows cross edges 159 times in total. The
  // coarsest grid that GL allows, 1/16 pixel, would move each by up to 1/32 pixel: past five
  // centres.
  EXPECT_LE(off, 5u);
}

TEST(ImageTiles, AResolutionScaleIsRefused) {
  const gl::Context context = gl::Context::create(osmesa);
  RenderOptions options;
  options.plan.quality.resolution_scale = 0.5;
  Renderer renderer = renderer_of(context, random_soup(9, {.kind = Kind::lattice}), {}, options);
  EXPECT_THROW(tiles_of(renderer, context.capabilities()), UsageError);
}

}  // namespace image_tiles_test
}  // namespace tureen::test
