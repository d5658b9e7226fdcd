#include "trainer/diffsoup/checkpoint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>

#include "base/existing_path.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/support/errors.hpp"
#include "tests/trainer/random_model.hpp"

namespace tureen::trainer {
namespace checkpoint_test {

using tureen::test::error_of;
using tureen::test::ErrorAt;
using tureen::test::ErrorIn;
using tureen::test::Names;
using tureen::test::Refusal;
namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Ne;
using Bytes = std::vector<std::byte>;

/// A run in which all numbers are different.
Checkpoint random_checkpoint(std::uint64_t seed) {
  test::Random random(seed);
  Checkpoint checkpoint;
  checkpoint.config.steps = 700;
  checkpoint.config.vertex_rate = 0.1f + float(random.uniform());
  checkpoint.views = {{"train/r_0", 3, 2, 17u, 18u}, {"train/\xc3\xa4 1", 4, 1, 19u, 20u}};
  checkpoint.seconds = 12.5 + random.uniform();
  TrainingState& state = checkpoint.state;
  state.model = test::random_model(seed, {.faces = 3, .min_level = 0, .max_level = 1});
  state.moments.reset_faces(state.model);
  const auto fill = [&random](auto& values) {
    for (auto& value : values) value = float(random.normal());
  };
  fill(state.moments.first);
  fill(state.moments.second);
  fill(state.moments.vertex_second);
  for (glm::vec3& moment : state.moments.vertex_first)
    moment = {random.normal(), random.normal(), random.normal()};
  state.moments.steps = {5, 0, 69};
  fill(state.moments.mlp_first);
  fill(state.moments.mlp_second);
  state.moments.mlp_steps = 70;
  state.step = 70;
  state.baseline = {0, 1, 2, 65535, 4, 5, 6, 7, 8, 9};
  state.errors = {0.5f, 0.0f, 2.25f};
  state.non_finite = 3;
  return checkpoint;
}

class CheckpointFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(::testing::TempDir()) /
              (std::string("tureen_checkpoint_") +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path path() const { return folder_ / "run.checkpoint"; }

  Bytes written(const Checkpoint& checkpoint) const {
    write_checkpoint(path(), checkpoint);
    Input input = Input::open(path());
    return input.read_rest();
  }
  std::optional<Refusal> refusal(const Checkpoint& checkpoint) const {
    return refusal(written(checkpoint));
  }
  static std::optional<Refusal> refusal(const Bytes& bytes) {
    return error_of([&] { read_checkpoint(Input::memory("run.checkpoint", bytes)); });
  }

  fs::path folder_;
};

TEST_F(CheckpointFile, HoldsARunBitByBit) {
  const std::uint64_t seed = 11;
  const Checkpoint a = random_checkpoint(seed);
  const Bytes bytes = written(a);
  const Checkpoint b = read_checkpoint(open_existing(path()));
  EXPECT_FALSE(difference(a.config, b.config)) << *difference(a.config, b.config);
  EXPECT_FALSE(difference(a.views, b.views));
  EXPECT_EQ(b.views[1].name, "train/\xc3\xa4 1");
  EXPECT_EQ(a.seconds, b.seconds);
  EXPECT_EQ(a.state.step, b.state.step);
  EXPECT_EQ(a.state.baseline, b.state.baseline);
  EXPECT_EQ(a.state.errors, b.state.errors);
  EXPECT_EQ(a.state.non_finite, b.state.non_finite);
  EXPECT_EQ(a.state.model.min_level, b.state.model.min_level);
  EXPECT_EQ(a.state.model.max_level, b.state.model.max_level);
  EXPECT_EQ(a.state.model.positions, b.state.model.positions);
  EXPECT_EQ(a.state.model.logits, b.state.model.logits);
  EXPECT_EQ(a.state.model.mlp, b.state.model.mlp);
  EXPECT_EQ(a.state.model.origin, b.state.model.origin);
  EXPECT_EQ(a.state.moments.first, b.state.moments.first);
  EXPECT_EQ(a.state.moments.second, b.state.moments.second);
  EXPECT_EQ(a.state.moments.vertex_first, b.state.moments.vertex_first);
  EXPECT_EQ(a.state.moments.vertex_second, b.state.moments.vertex_second);
  EXPECT_EQ(a.state.moments.steps, b.state.moments.steps);
  EXPECT_EQ(a.state.moments.mlp_first, b.state.moments.mlp_first);
  EXPECT_EQ(a.state.moments.mlp_second, b.state.moments.mlp_second);
  EXPECT_EQ(a.state.moments.mlp_steps, b.state.moments.mlp_steps);
  EXPECT_EQ(written(b), bytes) << "seed " << seed;
}

TEST_F(CheckpointFile, SurvivesTruncation) {
  const Bytes bytes = written(random_checkpoint(12));
  const auto survival = tureen::test::survive_truncation(
      bytes, [](std::span<const std::byte> cut) { read_checkpoint(Input::memory("cut", cut)); });
  EXPECT_EQ(survival.read, 0u);
  EXPECT_EQ(survival.refused, bytes.size());
}

TEST_F(CheckpointFile, RefusesEveryDamagedByte) {
  const Bytes bytes = written(random_checkpoint(13));
  const auto survival = tureen::test::survive_damage(bytes, [](std::span<const std::byte> damaged) {
    read_checkpoint(Input::memory("damaged", damaged));
  });
  EXPECT_EQ(survival.read, 0u);
  EXPECT_GT(survival.refused, 8 * bytes.size());
}

TEST_F(CheckpointFile, SaysWhatIsWrong) {
  Bytes bytes = written(random_checkpoint(14));
  bytes.push_back(std::byte(0));
  EXPECT_THAT(refusal(bytes), ErrorIn("run.checkpoint"));
  bytes.pop_back();
  bytes[bytes.size() / 2] ^= std::byte(1);
  EXPECT_THAT(refusal(bytes), ErrorIn("run.checkpoint"));
  bytes[8] = std::byte(99);
  EXPECT_THAT(refusal(bytes), ErrorAt("run.checkpoint@8", 99));
  bytes[0] = std::byte('?');
  EXPECT_THAT(refusal(bytes), ErrorIn("run.checkpoint"));
  bytes.resize(100);
  EXPECT_EQ(refusal(written(random_checkpoint(14))), std::nullopt);
  EXPECT_THROW(read_checkpoint(open_existing(folder_ / "other.checkpoint")), InputError);
}

TEST_F(CheckpointFile, RefusesStatesThatBelongToNoRun) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const auto changed = [](const std::function<void(Checkpoint&)>& change) {
    Checkpoint checkpoint = random_checkpoint(15);
    change(checkpoint);
    return checkpoint;
  };
  const auto expect = [&](const std::function<void(Checkpoint&)>& change, const auto&... values) {
    EXPECT_THAT(refusal(changed(change)), ErrorIn("run.checkpoint", values...));
  };
  expect([](Checkpoint& c) { c.state.step = 701; }, 701, 700);
  expect([](Checkpoint& c) { c.state.step = -1; }, -1, 700);
  expect([&](Checkpoint& c) { c.seconds = double(nan); });
  expect([](Checkpoint& c) { c.views[0].width = 0; }, "0 x 2");
  expect([](Checkpoint& c) { c.views[0].height = 65'537; }, "3 x 65537");
  expect([](Checkpoint& c) { c.views.pop_back(); }, 10, 6);
  expect([](Checkpoint& c) { c.state.errors.pop_back(); }, 2, 3);
  expect([](Checkpoint& c) { c.state.model.max_level = 8; }, 0, 8);
  expect([](Checkpoint& c) { c.state.model.min_level = 2; }, 2, 1);
  expect(
      [](Checkpoint& c) {
        c.state.errors.clear();
        c.state.model.positions.pop_back();
      },
      8);
  expect([](Checkpoint& c) { c.state.model.logits.pop_back(); }, 3, 215);
  expect([](Checkpoint& c) { c.state.moments.first.pop_back(); });
  expect([](Checkpoint& c) { c.state.moments.steps.pop_back(); });
  expect([&](Checkpoint& c) { c.state.model.positions[4].y = nan; });
  expect([&](Checkpoint& c) { c.state.model.logits[7] = infinity; });
  expect([&](Checkpoint& c) { c.state.model.mlp[594] = nan; });
  expect([&](Checkpoint& c) { c.state.model.origin.z = double(nan); });
  // The square of a finite gradient may overflow; the parameter then never moves again.
  EXPECT_EQ(refusal(changed([&](Checkpoint& c) { c.state.moments.second[3] = infinity; })),
            std::nullopt);
  EXPECT_EQ(refusal(changed([](Checkpoint& c) {
              c.state.baseline.clear();
              c.state.errors.clear();
            })),
            std::nullopt);
}

TEST_F(CheckpointFile, RefusesTheConstantsOfAnotherVersion) {
  const Bytes bytes = written(random_checkpoint(16));
  const auto refusal_with = [&](const std::string& from, const std::string& to) {
    std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size() - 4);
    const std::size_t at = text.find(from);
    if (at == std::string::npos || from.size() != to.size()) throw std::logic_error("bad test");
    text.replace(at, from.size(), to);
    const auto sum = std::uint32_t(
        crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size())));
    Bytes changed(text.size() + 4);
    std::memcpy(changed.data(), text.data(), text.size());
    std::memcpy(changed.data() + text.size(), &sum, 4);
    return refusal(changed);
  };
  EXPECT_EQ(refusal_with("\"steps\": 700,", "\"steps\": 701,"), std::nullopt);
  EXPECT_THAT(refusal_with("\"batch\": 4,", "\"butch\": 4,"), ErrorIn("run.checkpoint", "butch"));
  EXPECT_THAT(refusal_with("\"batch\": 4,", "           "), ErrorIn("run.checkpoint"));
}

TEST_F(CheckpointFile, IsWrittenWholeOrNotAtAll) {
  EXPECT_THROW(write_checkpoint(folder_ / "none" / "run.checkpoint", random_checkpoint(17)),
               OutputError);
  const Bytes before = written(random_checkpoint(17));
  fs::create_directories(folder_ / "taken" / "by a folder");
  EXPECT_THROW(write_checkpoint(folder_ / "taken", random_checkpoint(17)), OutputError);
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder_)) files += entry.is_regular_file();
  EXPECT_EQ(files, 1u);  // no temporary file stays
}

TEST(Difference, NamesTheFirstConstantThatIsAnother) {
  Config a, b;
  EXPECT_FALSE(difference(a, b));
  a.steps = 300;
  a.seed = 1;
  b.steps = 40;
  EXPECT_THAT(difference(a, b).value_or(""), Names("steps", 300, 40));
  a.steps = b.steps;
  EXPECT_THAT(difference(a, b).value_or(""), Names("seed", 1, 0));
}

Photograph photograph(const std::string& name) {
  Photograph result;
  result.camera = look_at({3, 0, 1}, {0, 0, 0}, {0, 0, 1}, 0.8, 4, 3);
  result.camera.name = name;
  result.image = Image8(4, 3, {1, 2, 3, 255});
  return result;
}

TEST(Difference, NamesTheFirstViewThatIsAnother) {
  const std::vector<Photograph> photographs{photograph("r_0"), photograph("r_1")};
  const auto then = fingerprint(photographs);
  const auto changed = [&](const std::function<void(Photograph&)>& change) {
    std::vector<Photograph> others = photographs;
    change(others[1]);
    return difference(fingerprint(others), then).value_or("");
  };
  EXPECT_EQ(changed([](Photograph&) {}), "");
  EXPECT_THAT(changed([](Photograph& p) { p.camera.name = "r_2"; }), Names(1, "r_2", "r_1"));
  EXPECT_THAT(changed([](Photograph& p) { p.camera.width = 8; }), Names("r_1", "8 x 3", "4 x 3"));
  const std::string camera = changed([](Photograph& p) { p.camera.cx += 1e-9; });
  EXPECT_THAT(camera, Names("r_1"));
  EXPECT_EQ(changed([](Photograph& p) { p.camera.view_from_world[3].x += 1e-9; }), camera);
  const std::string pixels = changed([](Photograph& p) {
    Image8 image = p.image();
    image.pixels[11].b = 4;
    p.image = image;
  });
  EXPECT_THAT(pixels, AllOf(Names("r_1"), Ne(camera)));
  EXPECT_THAT(difference(std::span(then).first(1), then).value_or(""), Names(1, 2));
}

}  // namespace checkpoint_test
}  // namespace tureen::trainer
