// What every ImageSource has in common, against the oracle.
#include "scene/image_source.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "image/metrics.hpp"
#include "jobs/baseline/baseline.hpp"
#include "oracle/oracle_images.hpp"
#include "runtime/image_tiles.hpp"
#include "runtime/renderer_images.hpp"
#include "runtime/splats/tile_images.hpp"
#include "scene/similarity.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"
#include "trainer/common/trainable.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/splats/gaussians/gaussian_training.hpp"
#include "trainer/splats/splat_initialise.hpp"

namespace tureen {
namespace image_source_test {

constexpr glm::vec3 background{0.2f, 0.4f, 0.6f};

/// A ball of Gaussians.
Scene scene() {
  return scene_of(tureen::test::random_splats(tureen::test::splat_kinds[1], 500, 0.1, 3));
}

class RuntimeImages final : public ImageSource {
 public:
  explicit RuntimeImages(const Scene& scene)
      : renderer_(make_renderer(context_, scene, PipelineKind::tureen, {})),
        images_(renderer_, background) {}
  Image8 image(const FrameInput& input) override { return images_.image(input); }

 private:
  gl::Context context_ = gl::Context::create({.backend = gl::Backend::osmesa});
  Renderer renderer_;
  RendererImages images_;
};

/// The state of a training that begins with the scene's Gaussians.
class TrainedImages final : public trainer::Trainable {
 public:
  explicit TrainedImages(const Scene& scene) {
    trainer::GaussianConfig config{{.max_splats = 10'000, .background = {0.2f, 0.4f, 0.6f}}};
    config.degree = 2;
    config.initialisation = trainer::Initialisation::mesh;
    Dataset dataset;
    const Region region{.center = glm::dvec3(0), .half_side = 2};
    trainer_.emplace(
        config, views_, region, 2,
        trainer::first_splats<trainer::GaussianTraining>(dataset, config, region, &scene));
  }
  int steps() const override { return 1; }
  int steps_done() const override { return 0; }
  void set_steps(int) override {}
  trainer::StepReport step() override { return {}; }
  trainer::PrimitiveCount primitives() const override {
    return {trainer::PrimitiveKind::splats, trainer_->parameters().count()};
  }
  std::vector<float> render(const Camera& camera) override { return trainer_->render(camera); }
  std::span<const float, 3> background() const override {
    return std::span<const float, 3>(trainer_->config().background);
  }
  void write_checkpoint(const std::filesystem::path&, double) const override {}

 private:
  std::vector<trainer::TrainingView> views_ = [] {
    trainer::TrainingView view;
    view.camera = tureen::test::camera_of_ball(3, 32, 32);
    view.target.assign(3 * 32 * 32, 0);
    return std::vector{view};
  }();
  std::optional<trainer::GaussianTrainer> trainer_;
};

struct Source {
  const char* name;
  std::unique_ptr<ImageSource> (*make)(const Scene&);
  bool has_coverage = true;
};
const Source sources[] = {{"oracle",
                           [](const Scene& scene) -> std::unique_ptr<ImageSource> {
                             return std::make_unique<OracleImages>(
                                 scene, OracleOptions{.background = background});
                           }},
                          {"runtime",
                           [](const Scene& scene) -> std::unique_ptr<ImageSource> {
                             return std::make_unique<RuntimeImages>(scene);
                           }},
                          {"tiles",
                           [](const Scene& scene) -> std::unique_ptr<ImageSource> {
                             return std::make_unique<TileImages>(scene, background);
                           }},
                          {"training",
                           [](const Scene& scene) -> std::unique_ptr<ImageSource> {
                             return std::make_unique<TrainedImages>(scene);
                           },
                           false}};

class ImageSources : public testing::TestWithParam<Source> {
 protected:
  const Scene scene_ = scene();
  const std::unique_ptr<ImageSource> source_ = GetParam().make(scene_);
};

double psnr(const ImageF& a, const ImageF& b) { return psnr_from_mse(mean_squared_error(a, b)); }

ImageF coverage_of(ImageF image) {
  for (glm::vec4& pixel : image.pixels) pixel = glm::vec4(glm::vec3(pixel.a), 1);
  return image;
}

TEST_P(ImageSources, ShowWhatTheOracleShows) {
  const Camera camera = tureen::test::camera_of_ball(3, 65, 47);
  const ImageF expected = oracle_image(scene_, {camera}, {.background = background}, camera.height);
  const ImageF found = to_float(source_->image({camera}));
  ASSERT_EQ(found.width, 65);
  ASSERT_EQ(found.height, 47);
  // Rounding to bytes alone gives 59 dB.
  EXPECT_GT(psnr(expected, found), 55);
  if (GetParam().has_coverage) {
    EXPECT_GT(psnr(coverage_of(expected), coverage_of(found)), 55);
  } else {
    EXPECT_TRUE(std::ranges::all_of(found.pixels, [](auto& pixel) { return pixel.a == 1; }));
  }
}

TEST_P(ImageSources, RoundTheirExactImages) {
  const Camera camera = tureen::test::camera_of_ball(3, 33, 20);
  const std::optional<ImageF> exact = source_->exact_image({camera});
  EXPECT_EQ(exact.has_value(), std::string(GetParam().name) != "runtime");
  if (exact) {
    EXPECT_EQ(quantised(*exact).pixels, source_->image({camera}).pixels);
  }
}

TEST_P(ImageSources, DrawPartsAsTheyAreInTheWhole) {
  const Camera camera = tureen::test::camera_of_ball(3, 64, 48);
  const Image8 whole = source_->image({camera});
  const Image8 part = source_->image({.camera = crop(camera, {16, 8}, {32, 24}), .whole = camera});
  int largest = 0;
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x)
      for (int c = 0; c < 4; ++c)
        largest = std::max(largest, std::abs(part.at(x, y)[c] - whole.at(x + 16, y + 8)[c]));
  EXPECT_LE(largest, 1);
}

INSTANTIATE_TEST_SUITE_P(All, ImageSources, testing::ValuesIn(sources),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(OracleImages, ReportProgressAndCanBeCancelled) {
  const Scene drawn = scene();
  struct Stop {};
  double last = -1;
  OracleImages images(drawn, {.progress = [&](double done) {
                        EXPECT_GE(done, last);
                        last = done;
                        throw Stop();
                      }});
  EXPECT_THROW(images.image({tureen::test::camera_of_ball(3, 640, 480)}), Stop);
}

/// Splats before, in and behind a soup. Strips of rows must not show.
TEST(OracleImages, EqualTheOracleInOnePiece) {
  Scene drawn = scene();
  drawn.layers.push_back({.primitives = tureen::test::random_soup(7, {.faces = 60})});
  const Camera camera = tureen::test::camera_of_ball(3, 41, 37);
  for (const auto& behind : {std::optional<glm::vec3>(), std::optional(background)}) {
    const OracleOptions options{.supersampling = 2, .background = behind};
    const ImageF expected = oracle_image(drawn, {camera}, options, camera.height);
    const ImageF found = OracleImages(drawn, options).exact_image({camera}).value();
    EXPECT_EQ(expected.pixels, found.pixels);
    if (!behind) {
      EXPECT_EQ(expected.pixels, render_oracle(drawn, {camera}, options).color.pixels);
    }
  }
}

TEST(TileImages, ShowPlacedLayersWithoutABackground) {
  Scene drawn = scene();
  drawn.layers[0].world_from_layer = matrix_of({.position = {0.4, -0.3, 0.2}, .scale = 0.7});
  for (int kind : {0, 6})  // windows, neural densities
    drawn.layers.push_back(
        {.world_from_layer =
             matrix_of({.position = {-0.5, 0.5, 0.1}, .scale = 0.5, .mirror = true}),
         .primitives = tureen::test::random_splats(tureen::test::splat_kinds[kind], 200, 0.1, 5)});
  drawn.layers.push_back(drawn.layers[0]);
  drawn.layers.back().visible = false;
  const Camera camera = tureen::test::camera_of_ball(3, 65, 47);
  const ImageF expected =
      oracle_image(drawn, {camera}, {.background = std::nullopt}, camera.height);
  const ImageF found = TileImages(drawn, std::nullopt).exact_image({camera}).value();
  EXPECT_GT(psnr(coverage_of(expected), coverage_of(found)), 55);
  // Colours count where there is coverage.
  double error = 0, weight = 0;
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    const glm::vec3 difference = glm::vec3(expected.pixels[i]) - glm::vec3(found.pixels[i]);
    error += expected.pixels[i].a * glm::dot(difference, difference) / 3;
    weight += expected.pixels[i].a;
  }
  EXPECT_GT(weight, 300);
  EXPECT_GT(psnr_from_mse(error / weight), 55);
}

TEST(TileImages, RefuseSoups) {
  Scene soup;
  soup.layers.emplace_back();
  EXPECT_THROW(TileImages(soup, background), UsageError);
}

}  // namespace image_source_test
}  // namespace tureen
