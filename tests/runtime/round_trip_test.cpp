// A soup that is written and read again draws identical pixels in GL, for every format that
// guarantees this. A loaded export agrees with the oracle.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "formats/scene_file.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/cutout_cloud.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen {
namespace round_trip_test {

using test::Drawn;
using test::Kind;
using tureen::test::TemporaryFolder;

gl::Context& context() {
  static gl::Context shared = gl::Context::create({});
  return shared;
}

Drawn draw(const Scene& scene, std::size_t view, const PlanPreferences& plan) {
  return test::draw(context(), only_soup(scene), origin_of(only_layer(scene)),
                    scene.cameras.at(view), plan);
}

Scene written_and_read(const Scene& scene, const std::filesystem::path& path) {
  write_scene(scene, path);
  return read_scene(path);
}

/// Compares colour, alpha and face of every pixel in the first view, for a deferred plan, which has
/// a face buffer, and for the default plan.
void expect_the_same_pixels(const Scene& written, const Scene& read) {
  const PlanPreferences plans[] = {{.site = ShadingSite::deferred}, {}};
  for (const PlanPreferences& plan : plans) {
    const Drawn before = draw(written, 0, plan), after = draw(read, 0, plan);
    ASSERT_EQ(before.color.pixels.size(), after.color.pixels.size());
    std::size_t other = 0, drawn = 0;
    for (std::size_t i = 0; i < before.color.pixels.size(); ++i) {
      other += before.color.pixels[i] != after.color.pixels[i];
      drawn += before.color.pixels[i] != glm::u8vec4(0, 0, 0, 255);
    }
    EXPECT_EQ(other, 0u) << "pixels differ; " << (plan.site ? "deferred" : "the plan's own choice");
    EXPECT_EQ(before.faces, after.faces);
    EXPECT_GT(drawn, before.color.pixels.size() / 20) << "too few pixels to compare";
  }
}

/// A scene with one random camera.
Scene scene_with_camera(TriangleSoup soup, std::uint64_t seed) {
  test::Random random(seed);
  Scene scene = scene_of(std::move(soup));
  scene.cameras = {test::random_camera(random, 320, 240)};
  return scene;
}

class RoundTrip : public ::testing::TestWithParam<std::tuple<Kind, int>> {
 protected:
  Kind kind() const { return std::get<0>(GetParam()); }
  std::uint64_t seed() const { return std::uint64_t(std::get<1>(GetParam())); }
};

TEST_P(RoundTrip, OfOurGlbDrawsTheSamePixels) {
  const TemporaryFolder folder;
  // The two seeds have different features: shared vertices, degenerate faces, float texels.
  const bool odd = seed() % 2 == 1;
  Scene scene = scene_with_camera(
      test::random_soup(seed(),
                        {.kind = kind(),
                         .shared_vertices = odd,
                         .degenerate = !odd,
                         .float_texels = odd,
                         .filter = odd ? UvMaterial::Filter::nearest : UvMaterial::Filter::linear}),
      seed());
  only_layer(scene).world_from_layer = at_origin({1e3 + 1e-9, -0.1, 1.0 / 3});
  scene.cameras[0].view_from_world *=
      glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, 1, 0),
                 glm::dvec4(-origin_of(only_layer(scene)), 1));
  expect_the_same_pixels(scene, written_and_read(scene, folder / "soup.glb"));
}

INSTANTIATE_TEST_SUITE_P(Soup, RoundTrip,
                         ::testing::Combine(::testing::ValuesIn(test::all_kinds),
                                            ::testing::Values(601, 602)),
                         [](const auto& i) {
                           return to_string(std::get<0>(i.param)) + "Seed" +
                                  std::to_string(std::get<1>(i.param));
                         });

class RoundTripOfColors : public ::testing::TestWithParam<std::tuple<const char*, Kind>> {};

// These formats do not store cameras, so the written scene's camera draws both images.
TEST_P(RoundTripOfColors, OfEightBitsDrawsTheSamePixels) {
  const TemporaryFolder folder;
  const auto& [extension, kind] = GetParam();
  TriangleSoup soup =
      test::random_soup(603, {.kind = kind, .shared_vertices = kind == Kind::vertex_colors});
  std::vector<glm::vec4>& rgba = kind == Kind::face_colors
                                     ? std::get<FaceColors>(soup.appearance).rgba
                                     : std::get<VertexColors>(soup.appearance).rgba;
  for (glm::vec4& color : rgba)
    for (int c = 0; c < 4; ++c) color[c] = std::round(color[c] * 255.0f) / 255.0f;
  const Scene scene = scene_with_camera(std::move(soup), 603);
  Scene read = written_and_read(scene, folder / (std::string("soup") + extension));
  read.cameras = scene.cameras;
  expect_the_same_pixels(scene, read);
}

INSTANTIATE_TEST_SUITE_P(Format, RoundTripOfColors,
                         ::testing::Combine(::testing::Values(".off", ".ply"),
                                            ::testing::Values(Kind::face_colors,
                                                              Kind::vertex_colors)),
                         [](const auto& i) {
                           return std::string(std::get<0>(i.param) + 1) +
                                  to_string(std::get<1>(i.param));
                         });

// -- the soup of the speed benchmarks, at full size ----------------------------------------------

// An export stores bytes unchanged, so its image is the same as the original's.
TEST(CutoutCloud, ReadFromADiffSoupExportAgreesWithTheOracle) {
  const TemporaryFolder folder;
  const Scene scene = test::cutout_cloud({.coverage = test::CloudCoverage::forty_percent});
  Scene read = written_and_read(scene, folder / "export");
  read.cameras = scene.cameras;
  for (const std::size_t view : {1, 4}) {
    const Drawn drawn = draw(read, view, {.site = ShadingSite::deferred});
    test::expect_agreement(
        test::snapped_oracle(only_soup(read), origin_of(only_layer(read)), read.cameras[view]),
        drawn, "view " + std::to_string(view),
        // The bound for the variant in gl_oracle_test.cpp.
        {.max_face_mismatch = 3e-5});
  }
  expect_the_same_pixels(scene, read);
}

TEST(CutoutCloud, ReadFromOurGlbDrawsTheSamePixels) {
  const TemporaryFolder folder;
  const Scene scene = test::cutout_cloud({.coverage = test::CloudCoverage::all});
  expect_the_same_pixels(scene, written_and_read(scene, folder / "cloud.glb"));
}

}  // namespace round_trip_test
}  // namespace tureen
