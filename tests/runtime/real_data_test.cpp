// Trained soups from other projects, loaded as a user loads them, compared with the oracle. Skipped
// without the data, which is not part of the project.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "camera/navigation.hpp"
#include "formats/scene_file.hpp"
#include "image/metrics.hpp"
#include "tests/support/agreement.hpp"

namespace tureen {
namespace real_data_test {

using test::Drawn;

std::filesystem::path data(const std::string& name) {
  return std::filesystem::path(TUREEN_SOURCE_DIR) / "../shared/data/soups" / name;
}

gl::Context& context() {
  static gl::Context shared = gl::Context::create({});
  return shared;
}

/// The first view of `tureen render`, and the opposite view.
std::vector<Camera> two_views(const Scene& scene) {
  return orbit(subject_of(scene), 2, three_quarter_view, {.width = 960, .height = 720});
}

Drawn draw(const Scene& scene, const Camera& camera, const PlanPreferences& plan) {
  return test::draw(context(), only_soup(scene), origin_of(only_layer(scene)), camera, plan);
}

struct RealSoup {
  const char* name;
  /// The plant fills 7 % of its image. The only available part of the drums, 11,026 scattered
  /// triangles, fills 1.6 to 2.2 %, which is still 11,000 pixels.
  double min_compared;
};
void PrintTo(const RealSoup& soup, std::ostream* out) { *out << soup.name; }

class RealData : public testing::TestWithParam<RealSoup> {};

TEST_P(RealData, AgreesWithTheOracle) {
  const auto [name, min_compared] = GetParam();
  if (!std::filesystem::exists(data(name))) GTEST_SKIP() << "no ../shared/data";
  const Scene scene = read_scene(data(name));
  const auto& soup = only_soup(scene);
  int view = 0;
  for (const Camera& camera : two_views(scene)) {
    const OracleImage oracle = test::snapped_oracle(soup, origin_of(only_layer(scene)), camera);
    Drawn drawn = draw(scene, camera, {.site = ShadingSite::deferred});
    const std::string which = "view " + std::to_string(view++);
    test::expect_agreement(oracle, drawn, which, {.min_compared = min_compared});
    // The default plan may shade forward; it covers the same pixels.
    drawn.color = draw(scene, camera, {}).color;
    test::expect_agreement(oracle, drawn, which + " as planned", {.min_compared = min_compared});
  }
}

INSTANTIATE_TEST_SUITE_P(Soup, RealData,
                         testing::Values(RealSoup{"ficus_2dts.glb", 0.05},
                                         RealSoup{"ficus_2dts.off", 0.05},
                                         RealSoup{"mobilenerf_drums", 0.01}),
                         [](const auto& i) {
                           std::string name = i.param.name;
                           for (char& c : name) c = c == '.' ? '_' : c;
                           return name;
                         });

// Both files have the same colour bytes, one per vertex, the other per face, and the same
// positions, one in decimals. The images are equal here. The requirement is 45 dB; an error of one
// step in one of sixteen pixels would be 60 dB.
TEST(RealDataPair, GlbAndOffShowTheSamePlant) {
  if (!std::filesystem::exists(data("ficus_2dts.glb"))) GTEST_SKIP() << "no ../shared/data";
  const Scene glb = read_scene(data("ficus_2dts.glb")), off = read_scene(data("ficus_2dts.off"));
  const std::vector<Camera> of_glb = two_views(glb), of_off = two_views(off);
  for (std::size_t view = 0; view < of_glb.size(); ++view) {
    const ImageF a = to_float(draw(glb, of_glb[view], {}).color);
    const ImageF b = to_float(draw(off, of_off[view], {}).color);
    const double psnr = psnr_from_mse(mean_squared_error(a, b));
    RecordProperty("psnr_of_view_" + std::to_string(view), std::to_string(psnr));
    EXPECT_GT(psnr, 60.0) << "view " << view;
  }
}

}  // namespace real_data_test
}  // namespace tureen
