#include "trainer/common/held_out.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace tureen::trainer {
namespace held_out_test {

TEST(SomeOf, SpreadsEvenlyFromTheFirst) {
  std::vector<Photograph> views(12);
  for (std::size_t i = 0; i < views.size(); ++i) views[i].camera.name = std::to_string(i);
  const auto names = [](const std::vector<Photograph>& chosen) {
    std::string text;
    for (const Photograph& view : chosen) text += view.camera.name + " ";
    return text;
  };
  EXPECT_EQ(names(some_of(views, 5)), "0 2 4 7 9 ");
  EXPECT_EQ(names(some_of(views, 1)), "0 ");
  EXPECT_EQ(some_of(views, 50).size(), 12u);
}

/// Draws one colour everywhere.
class OneColor final : public Trainable {
 public:
  explicit OneColor(float value) : value_(value) {}
  int steps() const override { return 1; }
  int steps_done() const override { return 0; }
  void set_steps(int) override {}
  StepReport step() override { return {}; }
  PrimitiveCount primitives() const override { return {PrimitiveKind::triangles, 1}; }
  std::vector<float> render(const Camera& camera) override {
    const std::size_t pixels = std::size_t(camera.width) * std::size_t(camera.height);
    std::vector<float> planes(3 * pixels, value_);
    std::fill_n(planes.begin(), pixels, 0.0f);  // no red
    return planes;
  }
  std::span<const float, 3> background() const override { return background_; }
  void write_checkpoint(const std::filesystem::path&, double) const override {}

 private:
  float value_;
  std::array<float, 3> background_{0.0f, 0.4f, 0.4f};
};

Photograph photograph(glm::u8vec4 color) {
  Photograph view;
  view.camera = look_at({3, 0, 1}, {0, 0, 0}, {0, 0, 1}, 0.8, 16, 12);
  view.image = Image8(16, 12, color);
  return view;
}

TEST(HeldOut, IsMeasuredAsTheEvaluationDoes) {
  OneColor run(0.2f + 0.4f / 255);  // rounds to 51
  // The same image, and a transparent one that shows the background: an error of 51 / 255 in two of
  // three channels.
  const std::vector<Photograph> views{photograph({0, 51, 51, 255}), photograph({9, 9, 9, 0})};
  const double off = -10 * std::log10(0.2 * 0.2 * 2 / 3);
  // Float rounding of the values is 6e-8.
  EXPECT_NEAR(mean_psnr_db(run, views), (100 + off) / 2, 1e-5);
  // A mask that excludes half of the wrong pixels: their number does not matter.
  std::vector<Photograph> masked{views[1]};
  std::vector<std::uint8_t> ignored(masked[0].image.pixels(), 0);
  std::fill_n(ignored.begin(), 96, 1);
  masked[0].ignored = ignored;
  EXPECT_NEAR(mean_psnr_db(run, masked), off, 1e-5);
  const Image8 image = run.image({views[0].camera});
  EXPECT_EQ(image.at(15, 11), glm::u8vec4(0, 51, 51, 255));
  const Image8 both = preview(run, views[1]);
  EXPECT_EQ(both.width, 3 * 16);
  EXPECT_EQ(both.at(0, 0), glm::u8vec4(0, 102, 102, 255));
  EXPECT_EQ(both.at(16, 0), glm::u8vec4(0, 51, 51, 255));
}

}  // namespace held_out_test
}  // namespace tureen::trainer
