#include "trainer/common/training_views.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "base/platform/scratch_file.hpp"
#include "tests/support/random.hpp"
#include "trainer/diffsoup/config_fields.hpp"

namespace tureen::trainer {
namespace training_views_test {

Photograph random_photograph(std::uint64_t seed) {
  test::Random random(seed);
  Photograph photograph;
  photograph.camera = look_at({3, 0, 1}, {0, 0, 0}, {0, 0, 1}, 0.8, 7, 5);
  photograph.camera.name = "r_" + std::to_string(seed);
  Image8 image(7, 5);
  const auto byte = [&random] { return static_cast<std::uint8_t>(random.uniform() * 255.99); };
  for (glm::u8vec4& pixel : image.pixels) pixel = {byte(), byte(), byte(), byte()};
  image.pixels[0].a = 0;
  image.pixels[1].a = 255;
  photograph.image = image;
  return photograph;
}

TEST(TrainingViews, AreThePhotographsOverTheBackgroundPlaneByPlane) {
  const Photograph photograph = random_photograph(1);
  Config config;
  config.background[0] = 1.0f;
  config.background[1] = 0.25f;
  config.background[2] = 0.0f;
  const TrainingView view = training_view(photograph, config.background);
  EXPECT_EQ(view.camera.name, "r_1");
  EXPECT_TRUE(view.ignored.empty());
  const Image8 image = photograph.image();
  const std::size_t pixels = image.pixels.size();
  ASSERT_EQ(view.target.size(), 3 * pixels);
  for (std::size_t p = 0; p < pixels; ++p)
    for (int c = 0; c < 3; ++c) {
      const glm::u8vec4 pixel = image.pixels[p];
      const double a = pixel.a / 255.0;
      const double exact = a * pixel[c] + (1 - a) * 255 * double(config.background[c]);
      // The nearest byte, plus rounding for values half way between two.
      EXPECT_NEAR(view.target[std::size_t(c) * pixels + p], exact, 0.5 + 1e-9) << p << " " << c;
    }
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(view.target[c * pixels + 1], image.pixels[1][int(c)]);  // opaque
    EXPECT_EQ(view.target[c * pixels], (std::array{255, 64, 0})[c]);  // transparent
  }
}

TEST(TrainingViews, IgnoreThePixelsThatAMaskExcludes) {
  std::vector<Photograph> photographs{random_photograph(1), random_photograph(2)};
  std::vector<std::uint8_t> mask(photographs[1].image.pixels(), 0);
  mask[8] = 1;
  photographs[1].ignored = mask;
  const std::vector<TrainingView> views = take_training_views(photographs, Config{}.background);
  EXPECT_TRUE(views[0].ignored.empty());
  EXPECT_EQ(views[1].ignored, mask);
  EXPECT_TRUE(photographs[1].ignored.empty());
}

TEST(TrainingViews, AreTheSameFromAFile) {
  for (const bool is_opaque : {false, true}) {
    Photograph photograph = random_photograph(3);
    Image8 image = photograph.image();
    for (glm::u8vec4& pixel : image.pixels) pixel.a = is_opaque ? 255 : pixel.a;
    photograph.image = image;
    std::vector<std::uint8_t> mask(image.pixels.size(), 0);
    mask[8] = 1;
    photograph.ignored = mask;
    const std::array background{1.0f, 0.25f, 0.0f};
    const TrainingView expected = training_view(photograph, background);
    photograph.move_to(std::make_shared<ScratchFile>());
    std::vector<Photograph> photographs{photograph};
    const std::vector<TrainingView> views = take_training_views(photographs, background);
    ASSERT_TRUE(views[0].stored);
    EXPECT_TRUE(views[0].target.empty());
    EXPECT_TRUE(has_ignored(views[0]));
    expect(views[0]);
    EXPECT_EQ(loaded(views[0]).target, expected.target);
    EXPECT_EQ(loaded(views[0]).ignored, expected.ignored);
    TrainingView again = expected;
    store(again, photograph.file());
    EXPECT_EQ(loaded(again).target, expected.target);
    EXPECT_EQ(loaded(again).ignored, expected.ignored);
  }
}

TEST(TrainingViews, AreTakenOutOfTheDataset) {
  std::vector<Photograph> photographs{random_photograph(1), random_photograph(2)};
  const TrainingView expected = training_view(photographs[1], Config{}.background);
  const std::vector<TrainingView> views = take_training_views(photographs, Config{}.background);
  ASSERT_EQ(views.size(), 2u);
  EXPECT_EQ(views[1].target, expected.target);
  EXPECT_EQ(photographs.size(), 2u);
  EXPECT_EQ(photographs[1].camera.name, "r_2");
  EXPECT_EQ(photographs[0].image.pixels(), 0u);
}

TEST(ScaledTo, ChangesLengthsOfTrainingAndNothingElse) {
  const Config config = preset(Preset::scene);
  const Config scaled = scaled_to(config, 6.0);  // four times the reference
  EXPECT_FLOAT_EQ(scaled.vertex_rate, 4 * config.vertex_rate);
  EXPECT_FLOAT_EQ(scaled.near, 4 * config.near);
  EXPECT_FLOAT_EQ(scaled.far, 4 * config.far);
  for (const ConfigField& field : config_fields()) {
    const std::string name = field.name;
    if (name == "vertex_rate" || name == "near" || name == "far") continue;
    EXPECT_EQ(value_text(scaled, field), value_text(config, field)) << name;
  }
  const Config same = scaled_to(config, reference_extent);
  for (const ConfigField& field : config_fields())
    EXPECT_EQ(value_text(same, field), value_text(config, field)) << field.name;
}

}  // namespace training_views_test
}  // namespace tureen::trainer
