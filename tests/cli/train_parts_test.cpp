// The parts of `tureen train` that need no training.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "cli/config_options.hpp"
#include "cli/held_out.hpp"
#include "cli/training_files.hpp"
#include "cli/training_session.hpp"
#include "tests/support/errors.hpp"
#include "trainer/diffsoup/config_fields.hpp"

namespace tureen::cli {
namespace train_parts_test {

namespace fs = std::filesystem;
using trainer::Config;
using trainer::Preset;

TEST(DurationText, IsShortAndRounded) {
  EXPECT_EQ(duration_text(0.4), "0 s");
  EXPECT_EQ(duration_text(59.4), "59 s");
  EXPECT_EQ(duration_text(59.6), "1 min 0 s");
  EXPECT_EQ(duration_text(425), "7 min 5 s");
  EXPECT_EQ(duration_text(3599.7), "1 h 0 min");
  EXPECT_EQ(duration_text(90061), "25 h 1 min");
}

TEST(TrainingFiles, LieBesideTheSoup) {
  const TrainingFiles files = training_files("runs/a.b.glb");
  EXPECT_EQ(files.scene, "runs/a.b.glb");
  EXPECT_EQ(files.checkpoint, "runs/a.b.checkpoint");
  EXPECT_EQ(files.log, "runs/a.b.jsonl");
  EXPECT_EQ(files.previews, "runs/a.b.previews");
  EXPECT_TRUE(files.diffsoup_export.empty());
  EXPECT_THROW(training_files("a"), UsageError);
  EXPECT_THROW(training_files("a.gltf"), UsageError);
}

TEST(TrainingFiles, AreTriedAndLeaveNothing) {
  const fs::path folder = fs::path(testing::TempDir()) / "tureen_training_files";
  fs::remove_all(folder);
  fs::create_directories(folder / "full");
  std::ofstream(folder / "full" / "letter.txt") << "dear";
  TrainingFiles files = training_files(folder / "a.glb");
  EXPECT_NO_THROW(check_writable(files));
  files.diffsoup_export = folder / "new";
  EXPECT_NO_THROW(check_writable(files));
  files.diffsoup_export = folder / "none" / "new";
  EXPECT_THROW(check_writable(files), OutputError);
  files.diffsoup_export = folder / "full";
  EXPECT_THROW(check_writable(files), UsageError);
  files = training_files(folder / "a.glb");
  files.log = folder / "full";
  EXPECT_THROW(check_writable(files), OutputError);
  EXPECT_THROW(check_writable(training_files(folder / "none" / "a.glb")), OutputError);
  std::size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : fs::recursive_directory_iterator(folder)) ++entries;
  EXPECT_EQ(entries, 2u);
  fs::remove_all(folder);
}

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
class OneColor final : public trainer::Backend {
 public:
  explicit OneColor(float value) : value_(value) {}
  std::string description() const override { return "one colour"; }
  void upload(const trainer::TrainingState&) override {}
  void download(trainer::TrainingState&) const override {}
  trainer::StepReport step(std::span<const std::uint32_t>, const trainer::Rates&) override {
    return {};
  }
  trainer::StageTimes take_times() override { return {}; }
  std::vector<std::uint64_t> visible_pixels(std::span<const Camera>) override { return {}; }
  std::vector<float> render(const Camera& camera) override {
    const std::size_t pixels = std::size_t(camera.width) * std::size_t(camera.height);
    std::vector<float> planes(3 * pixels, value_);
    std::fill_n(planes.begin(), pixels, 0.0f);  // no red
    return planes;
  }

 private:
  float value_;
};

Photograph photograph(glm::u8vec4 color) {
  Photograph view;
  view.camera = look_at({3, 0, 1}, {0, 0, 0}, {0, 0, 1}, 0.8, 16, 12);
  view.image = Image8(16, 12, color);
  return view;
}

TEST(HeldOut, IsMeasuredAsTheEvaluationDoes) {
  OneColor backend(0.2f + 0.4f / 255);  // rounds to 51
  Config config;
  config.background[0] = 0.0f;
  config.background[1] = config.background[2] = 0.4f;
  // The same picture, and one that shows the background through and through: off by 51 / 255 in
  // two of three channels.
  const std::vector<Photograph> views{photograph({0, 51, 51, 255}), photograph({9, 9, 9, 0})};
  const double off = -10 * std::log10(0.2 * 0.2 * 2 / 3);
  // Floats hold the values to 6e-8.
  EXPECT_NEAR(mean_psnr_db(backend, views, config), (100 + off) / 2, 1e-5);
  const Image8 image = drawn(backend, views[0].camera);
  EXPECT_EQ(image.at(15, 11), glm::u8vec4(0, 51, 51, 255));
  const Image8 both = preview(backend, views[1], config);
  EXPECT_EQ(both.width, 3 * 16);
  EXPECT_EQ(both.at(0, 0), glm::u8vec4(0, 102, 102, 255));
  EXPECT_EQ(both.at(16, 0), glm::u8vec4(0, 51, 51, 255));
}

TEST(ConfigOptions, KeepTheProportionOfTrianglesToBeginWith) {
  const Config base = trainer::published(Preset::object);
  ConfigOptions options;
  options.triangles = 3000;
  const Config config = with_options(base, options);
  EXPECT_EQ(config.triangles, 3000);
  EXPECT_EQ(config.initial_triangles, base.initial_triangles / 5);
  options.triangles = 0;
  EXPECT_THROW(with_options(base, options), UsageError);
  options.triangles = 1;
  EXPECT_GE(with_options(base, options).initial_triangles, 1);
}

TEST(ConfigOptions, AreRefusedByTheNumberThatWasTyped) {
  const auto refusal = [](std::optional<std::int64_t> ConfigOptions::*option, std::int64_t value) {
    ConfigOptions options;
    options.*option = value;
    return test::error_of<UsageError>([&] { with_options({}, options); });
  };
  using test::Names;
  EXPECT_THAT(refusal(&ConfigOptions::triangles, 99'999'999'999),
              Names("triangles", "99999999999", 4000000));
  EXPECT_THAT(refusal(&ConfigOptions::steps, -99'999'999'999),
              Names("steps", "-99999999999", 10000000));
  EXPECT_THAT(refusal(&ConfigOptions::batch, 1LL << 40), Names("batch", "1099511627776"));
  EXPECT_THAT(refusal(&ConfigOptions::level, 1LL << 40), Names("max_level", "1099511627776"));
}

TEST(ConfigOptions, LowerWhatWouldBeAboveTheLevel) {
  ConfigOptions options;
  options.level = 1;
  Config base = trainer::preset(Preset::object);
  base.coarse_level = 2;
  const Config config = with_options(base, options);
  EXPECT_EQ(config.max_level, 1);
  EXPECT_EQ(config.min_level, 1);
  EXPECT_EQ(config.coarse_level, 1);
  options.level = 6;
  EXPECT_EQ(with_options(base, options).min_level, base.min_level);
}

TEST(ConfigOptions, ChangeNothingThatIsNotGiven) {
  for (const Preset kind : {Preset::object, Preset::scene}) {
    const Config base = trainer::published(kind), same = with_options(base, {});
    for (const trainer::ConfigField& field : trainer::config_fields())
      EXPECT_EQ(value_text(same, field), value_text(base, field)) << field.name;
  }
}

TEST(ConfigOptions, TellTheWordsOfInitFromAFile) {
  ConfigOptions options;
  EXPECT_EQ(options.mesh(), "");
  options.begin = "random";
  EXPECT_EQ(options.mesh(), "");
  options.begin = "./random";
  EXPECT_EQ(options.mesh(), "./random");
  EXPECT_EQ(with_options({}, options).initialisation, trainer::Initialisation::mesh);
}

}  // namespace train_parts_test
}  // namespace tureen::cli
