#include "tests/trainer/backend_agreement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/existing_path.hpp"
#include "tests/support/random.hpp"
#include "tests/trainer/random_model.hpp"
#include "trainer/diffsoup/checkpoint.hpp"
#include "trainer/diffsoup/trainer.hpp"

namespace tureen::trainer::test {

namespace {

constexpr glm::dvec3 origin{10.0, -20.0, 30.0};  // random_model's

/// A camera that looks at the model from a random side, with its principal point off the centre.
Camera random_camera(Random& random, int width, int height) {
  Camera camera = look_at(origin + 4.0 * random.direction(), origin, {0, 0, 1}, 1.0, width, height);
  camera.cx += 1.25;
  camera.cy -= 0.75;
  return camera;
}

struct Fixture {
  Config config;
  std::vector<TrainingView> views;
  TrainingState state;

  Fixture(std::uint64_t seed, const ModelOptions& model, int width, int height,
          std::size_t view_count = 3) {
    std::cout << "seed " << seed << '\n';
    Random random(seed);
    config.seed = seed;
    state.model = random_model(seed, model);
    // Triangles as large as the cloud, one behind the other.
    for (std::size_t face = 0; face < state.model.faces(); ++face) {
      glm::vec3* p = &state.model.positions[3 * face];
      for (int i = 1; i < 3; ++i) p[i] += p[0];
    }
    state.moments.reset_faces(state.model);
    for (std::size_t i = 0; i < view_count; ++i) {
      TrainingView& view = views.emplace_back();
      view.camera = random_camera(random, width + int(i), height - int(i));
      const std::size_t pixels = std::size_t(view.camera.width) * std::size_t(view.camera.height);
      for (std::size_t p = 0; p < 3 * pixels; ++p)
        view.target.push_back(std::uint8_t(random.below(256)));
    }
  }
};

std::vector<std::uint32_t> all_views(const Fixture& fixture) {
  std::vector<std::uint32_t> result;
  for (std::uint32_t i = 0; i < fixture.views.size(); ++i) result.push_back(i);
  return result;
}

constexpr Rates rates{.texture = 5e-2f, .mlp = 1e-2f, .vertex = 1e-3f};

/// The distance between two arrays: the root mean square, and the fraction that differ by more than
/// `threshold`.
struct Distance {
  double rms = 0, outliers = 0;
};

Distance distance(std::span<const float> a, std::span<const float> b, double threshold) {
  EXPECT_EQ(a.size(), b.size());
  Distance result;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = double(a[i]) - double(b[i]);
    result.rms += d * d;
    result.outliers += !(std::abs(d) <= threshold);
  }
  result.rms = std::sqrt(result.rms / double(a.size()));
  result.outliers /= double(a.size());
  return result;
}

std::span<const float> floats(const std::vector<glm::vec3>& values) {
  return {&values.data()->x, 3 * values.size()};
}

/// Compares moments, which are sums of gradients; after Adam's step their size would be hidden.
/// Another order of sums, fixed point (2^-50 per term) and other contractions to fused
/// multiply-adds leave errors of 1e-6 of the largest gradient. Errors are larger only where
/// rounding decides which face a pixel shows: one in 10^5 pixels, none with these seeds. The bound
/// allows a hundredth.
void expect_close(std::span<const float> a, std::span<const float> b, const char* what) {
  float largest = 0;
  for (const float value : b) largest = std::max(largest, std::abs(value));
  ASSERT_GT(largest, 0) << what << " is zero, nothing was compared";
  EXPECT_LE(distance(a, b, 1e-5 * double(largest)).outliers, 0.01) << what;
}

void expect_same_states(const TrainingState& actual, const TrainingState& expected) {
  EXPECT_EQ(actual.step, expected.step);
  EXPECT_EQ(actual.moments.mlp_steps, expected.moments.mlp_steps);
  EXPECT_EQ(actual.moments.steps, expected.moments.steps);
  expect_close(actual.moments.first, expected.moments.first, "gradient of the textures");
  expect_close(floats(actual.moments.vertex_first), floats(expected.moments.vertex_first),
               "gradient of the corners");
  expect_close(actual.errors, expected.errors, "errors");
  expect_close(actual.moments.mlp_first, expected.moments.mlp_first, "gradient of the network");
  // The first step of Adam is the rate times the gradient's sign. A gradient that is zero up to
  // rounding has a random sign. All other numbers agree to a hundredth of a step.
  EXPECT_LE(distance(actual.model.logits, expected.model.logits, 0.01 * rates.texture).outliers,
            0.01);
  EXPECT_LE(distance(floats(actual.model.positions), floats(expected.model.positions),
                     0.01 * rates.vertex)
                .outliers,
            0.01);
  EXPECT_LE(distance(actual.model.mlp, expected.model.mlp, 0.01 * rates.mlp).outliers, 0.01);
  ASSERT_EQ(actual.baseline.size(), expected.baseline.size());
  std::size_t differing = 0;
  for (std::size_t i = 0; i < actual.baseline.size(); ++i)
    differing += std::abs(int(actual.baseline[i]) - int(expected.baseline[i])) > 1;
  // Rounding can give pixels to another face, at most one in a thousand.
  EXPECT_LE(differing, 1 + actual.baseline.size() / 1000);
}

void expect_same_step_of(const MakeBackend& make, const Fixture& fixture) {
  const auto actual_backend = make(fixture.views, fixture.config);
  const auto expected_backend = make_cpu_backend(fixture.views, fixture.config, 1);
  actual_backend->upload(fixture.state);
  expected_backend->upload(fixture.state);
  const StepReport actual = actual_backend->step(all_views(fixture), rates);
  const StepReport expected = expected_backend->step(all_views(fixture), rates);
  // Means of floats of about 1: measured differences are 1e-8 to 3e-8; one pixel of another face is
  // 1e-4.
  EXPECT_NEAR(actual.loss, expected.loss, 1e-6);
  EXPECT_NEAR(actual.l1, expected.l1, 1e-6);
  EXPECT_NEAR(actual.ssim, expected.ssim, 1e-6);
  EXPECT_NEAR(actual.mse, expected.mse, 1e-6);
  EXPECT_EQ(actual.non_finite, 0u);
  EXPECT_EQ(expected.non_finite, 0u);
  const StageTimes actual_times = actual_backend->take_times();
  const StageTimes expected_times = expected_backend->take_times();
  EXPECT_EQ(actual_times.pixels, expected_times.pixels);
  EXPECT_EQ(actual_times.shaded_pixels, expected_times.shaded_pixels);
  EXPECT_GT(actual_times.shaded_pixels, actual_times.pixels / 10);
  // Each shaded pixel is at least one fragment. The processor skips hidden faces. A ten-thousandth
  // allows for pixels whose centre is exactly on an edge.
  EXPECT_GE(expected_times.fragments, expected_times.shaded_pixels);
  EXPECT_LE(double(expected_times.fragments), 1.0001 * double(actual_times.fragments));
  EXPECT_EQ(actual_backend->take_times().fragments, 0u);
  TrainingState a, b;
  actual_backend->download(a);
  expected_backend->download(b);
  expect_same_states(a, b);
  // A second step: the sums of a step must not remain in the next. Differences after the first step
  // are larger by then, because Adam's step is the rate for even the smallest gradient.
  EXPECT_NEAR(actual_backend->step(all_views(fixture), rates).loss,
              expected_backend->step(all_views(fixture), rates).loss, 1e-4);
  actual_backend->download(a);
  expected_backend->download(b);
  EXPECT_LE(distance(a.model.logits, b.model.logits, 0.1 * rates.texture).outliers, 0.01);
  EXPECT_LE(
      distance(floats(a.model.positions), floats(b.model.positions), 0.1 * rates.vertex).outliers,
      0.01);
}

bool same_bits(std::span<const float> a, std::span<const float> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

void expect_same_bits(const TrainingState& a, const TrainingState& b) {
  EXPECT_TRUE(same_bits(a.model.logits, b.model.logits));
  EXPECT_TRUE(same_bits(floats(a.model.positions), floats(b.model.positions)));
  EXPECT_TRUE(same_bits(a.model.mlp, b.model.mlp));
  EXPECT_TRUE(same_bits(a.moments.first, b.moments.first));
  EXPECT_TRUE(same_bits(a.moments.second, b.moments.second));
  EXPECT_TRUE(same_bits(floats(a.moments.vertex_first), floats(b.moments.vertex_first)));
  EXPECT_TRUE(same_bits(a.moments.vertex_second, b.moments.vertex_second));
  EXPECT_TRUE(same_bits(a.moments.mlp_first, b.moments.mlp_first));
  EXPECT_TRUE(same_bits(a.moments.mlp_second, b.moments.mlp_second));
  EXPECT_EQ(a.moments.steps, b.moments.steps);
  EXPECT_EQ(a.moments.mlp_steps, b.moments.mlp_steps);
  EXPECT_EQ(a.baseline, b.baseline);
  EXPECT_TRUE(same_bits(a.errors, b.errors));
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.model.origin, b.model.origin);
}

}  // namespace

void expect_same_images(const MakeBackend& make) {
  for (const std::uint64_t seed : {1u, 2u}) {
    const Fixture fixture(seed, {.faces = 60, .min_level = 1, .max_level = 3}, 75, 53);
    const auto actual = make(fixture.views, fixture.config);
    const auto expected = make_cpu_backend(fixture.views, fixture.config, 1);
    actual->upload(fixture.state);
    expected->upload(fixture.state);
    std::vector<Camera> cameras;
    for (const TrainingView& view : fixture.views) {
      cameras.push_back(view.camera);
      // The arithmetic is the same up to contractions: 1e-5, where rounding does not decide on a
      // face.
      const Distance d = distance(actual->render(view.camera), expected->render(view.camera), 1e-5);
      EXPECT_LE(d.outliers, 0.001);
    }
    const auto a = actual->visible_pixels(cameras), b = expected->visible_pixels(cameras);
    ASSERT_EQ(a.size(), b.size());
    std::uint64_t off = 0, all = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      off += a[i] > b[i] ? a[i] - b[i] : b[i] - a[i];
      all += b[i];
    }
    EXPECT_GT(all, 3000u);
    // The same pixel by pixel, except exactly on an edge or a border of opacity: there,
    // contractions to fused multiply-adds decide, which the languages do not define.
    EXPECT_LE(off, all / 1000);
  }
}

void expect_same_step(const MakeBackend& make) {
  for (const std::uint64_t seed : {3u, 4u})
    expect_same_step_of(make, Fixture(seed, {.faces = 60, .min_level = 1, .max_level = 3}, 75, 53));
}

void expect_same_step_in_odd_cases(const MakeBackend& make) {
  {
    SCOPED_TRACE("smaller than a window of SSIM");
    expect_same_step_of(make, Fixture(5, {.faces = 30, .min_level = 0, .max_level = 2}, 31, 10));
  }
  {
    SCOPED_TRACE("one level, no baseline");
    Fixture fixture(6, {.faces = 40, .min_level = 0, .max_level = 0}, 64, 48, 1);
    fixture.config.baseline = false;
    expect_same_step_of(make, fixture);
  }
  {
    SCOPED_TRACE("gradients in half precision");
    Fixture fixture(13, {.faces = 40, .min_level = 1, .max_level = 2}, 64, 48);
    fixture.config.gradient_precision = GradientPrecision::float16;
    expect_same_step_of(make, fixture);
  }
  {
    SCOPED_TRACE("ignored pixels, a running baseline, dense updates");
    Fixture fixture(7, {.faces = 50, .min_level = 2, .max_level = 4}, 48, 40);
    fixture.config.dense_updates = true;
    Random random(7);
    for (std::size_t i = 1; i < fixture.views.size(); ++i)
      for (std::size_t p = 0; p < fixture.views[i].target.size() / 3; ++p)
        fixture.views[i].ignored.push_back(random.chance(0.3));
    for (const TrainingView& view : fixture.views)
      for (std::size_t p = 0; p < view.target.size() / 3; ++p)
        fixture.state.baseline.push_back(std::uint16_t(random.below(65536)));
    expect_same_step_of(make, fixture);
  }
  {
    SCOPED_TRACE("faces behind an opaque one, which the processor skips");
    Fixture fixture(16, {.faces = 300, .min_level = 1, .max_level = 2}, 64, 48);
    // A wall in front of the first camera, between it and all other faces.
    const Camera& camera = fixture.views[0].camera;
    const glm::dmat3 axes = camera.world_from_view_rotation();
    const glm::dvec3 middle = camera.eye() - origin - 0.2 * axes[2];
    glm::vec3* corners = fixture.state.model.positions.data();
    corners[0] = middle - 2.0 * axes[0] - 2.0 * axes[1];
    corners[1] = middle + 2.0 * axes[0] - 2.0 * axes[1];
    corners[2] = middle + 4.0 * axes[1];
    const std::size_t texels = fixture.state.model.texels();
    for (std::size_t i = 0; i < texels; ++i)
      fixture.state.model.logits[i * channels + alpha_channel] = 20;
    fixture.views.resize(1);
    fixture.config.near = 0.1f;
    const auto backend = make_cpu_backend(fixture.views, fixture.config, 1);
    backend->upload(fixture.state);
    backend->step(all_views(fixture), rates);
    const StageTimes times = backend->take_times();
    EXPECT_EQ(times.shaded_pixels, times.pixels);
    EXPECT_LT(times.fragments, 3 * times.pixels);  // about 30 times as many without the wall
    expect_same_step_of(make, fixture);
  }
  {
    SCOPED_TRACE("a backing layer");
    Fixture fixture(15, {.faces = 50, .min_level = 1, .max_level = 2}, 64, 48);
    fixture.config.backing_triangles = 20;
    expect_same_step_of(make, fixture);
    const auto backend = make(fixture.views, fixture.config);
    backend->upload(fixture.state);
    backend->step(all_views(fixture), rates);
    TrainingState after;
    backend->download(after);
    const auto positions = std::span(after.model.positions),
               old = std::span(fixture.state.model.positions);
    EXPECT_TRUE(std::ranges::equal(positions.first(60), old.first(60)));
    EXPECT_FALSE(std::ranges::equal(positions.subspan(60), old.subspan(60)));
    EXPECT_NE(after.model.logits[0], fixture.state.model.logits[0]);
  }
}

void expect_state_kept(const MakeBackend& make) {
  Fixture fixture(8, {.faces = 20, .min_level = 1, .max_level = 3}, 32, 24);
  Random random(8);
  const auto fill = [&](auto& values) {
    for (float& value : values) value = float(random.normal());
  };
  Moments& moments = fixture.state.moments;
  fill(moments.first);
  fill(moments.second);
  fill(moments.vertex_second);
  fill(moments.mlp_first);
  fill(moments.mlp_second);
  for (glm::vec3& v : moments.vertex_first) v = {float(random.normal()), 2, 3};
  for (std::uint32_t& steps : moments.steps) steps = random.below(1000);
  moments.mlp_steps = 77;
  fixture.state.errors.resize(fixture.state.model.faces());
  fill(fixture.state.errors);
  fixture.state.step = 99;
  fixture.state.non_finite = 5;
  for (const TrainingView& view : fixture.views)
    for (std::size_t p = 0; p < view.target.size() / 3; ++p)
      fixture.state.baseline.push_back(std::uint16_t(random.below(65536)));
  const auto backend = make(fixture.views, fixture.config);
  backend->upload(fixture.state);
  TrainingState back;
  backend->download(back);
  expect_same_bits(back, fixture.state);
  EXPECT_EQ(back.non_finite, 5u);
  EXPECT_EQ(back.model.min_level, 1);
  EXPECT_EQ(back.model.max_level, 3);
}

void expect_same_bits_again(const MakeBackend& make_first, const MakeBackend& make_second) {
  const Fixture fixture(9, {.faces = 40, .min_level = 1, .max_level = 2}, 50, 40);
  const auto first = make_first(fixture.views, fixture.config);
  first->upload(fixture.state);
  auto second = make_second(fixture.views, fixture.config);
  second->upload(fixture.state);
  for (int step = 0; step < 4; ++step) {
    if (step == 2) {
      TrainingState saved;
      second->download(saved);
      second = make_second(fixture.views, fixture.config);
      second->upload(saved);
    }
    const StepReport a = first->step(all_views(fixture), rates);
    const StepReport b = second->step(all_views(fixture), rates);
    EXPECT_EQ(a.loss, b.loss);
  }
  TrainingState a, b;
  first->download(a);
  second->download(b);
  expect_same_bits(a, b);
}

void expect_same_end_after_a_break(const MakeBackend& make) {
  Fixture fixture(14, {.faces = 40, .min_level = 1, .max_level = 1}, 50, 40);
  Config& config = fixture.config;
  config.steps = 12;
  config.triangles = config.initial_triangles = 40;
  config.coarse_level = config.min_level = 1;
  config.max_level = 2;
  config.lift_at = 0.5f;
  config.resample_every = 5;
  config.batch = 2;
  const auto trained = [&](const TrainingState& state, int until) {
    Trainer trainer(config, fixture.views, make(fixture.views, config), state);
    while (trainer.steps_done() < until) trainer.step();
    return trainer.state();
  };
  const TrainingState whole = trained(fixture.state, config.steps);
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) /
      (std::string(testing::UnitTest::GetInstance()->current_test_info()->test_suite_name()) +
       "_break.checkpoint");
  // A checkpoint names its views, and contains a baseline for their pixels.
  std::vector<ViewFingerprint> views;
  for (const TrainingView& view : fixture.views)
    views.push_back(
        {"view " + std::to_string(views.size()), view.camera.width, view.camera.height, 1u, 2u});
  // Before, at and after a resampling and the lift.
  for (const int step : {1, 5, 6, 8}) {
    SCOPED_TRACE("broken off after step " + std::to_string(step));
    write_checkpoint(
        path,
        {.config = config, .views = views, .seconds = 0, .state = trained(fixture.state, step)});
    const TrainingState resumed = trained(read_checkpoint(open_existing(path)).state, config.steps);
    expect_same_bits(resumed, whole);
    EXPECT_EQ(resumed.model.faces(), whole.model.faces());
  }
  std::filesystem::remove(path);
}

void expect_quarantine(const MakeBackend& make) {
  Fixture fixture(10, {.faces = 40, .min_level = 1, .max_level = 2}, 50, 40);
  // The texture of a face has NaN features, so the pixels that it wins with its valid alpha are
  // NaN.
  std::size_t face = 0;
  {
    const auto cpu = make_cpu_backend(fixture.views, fixture.config, 1);
    cpu->upload(fixture.state);
    std::vector<Camera> cameras;
    for (const TrainingView& view : fixture.views) cameras.push_back(view.camera);
    const auto counts = cpu->visible_pixels(cameras);
    face = std::size_t(std::max_element(counts.begin(), counts.end()) - counts.begin());
  }
  std::span<float> logits = fixture.state.model.face_logits(face);
  for (std::size_t i = 0; i < logits.size(); i += channels)
    logits[i] = std::numeric_limits<float>::quiet_NaN();
  const auto backend = make(fixture.views, fixture.config);
  const auto cpu = make_cpu_backend(fixture.views, fixture.config, 1);
  backend->upload(fixture.state);
  cpu->upload(fixture.state);
  const StepReport actual = backend->step(all_views(fixture), rates);
  const StepReport expected = cpu->step(all_views(fixture), rates);
  EXPECT_GT(expected.non_finite, 0u);
  EXPECT_EQ(actual.non_finite, expected.non_finite);
  EXPECT_NEAR(actual.loss, expected.loss, 1e-6);
  TrainingState after;
  backend->download(after);
  EXPECT_EQ(after.non_finite, actual.non_finite);
  // The NaN does not spread.
  for (std::size_t i = 0; i < after.model.faces(); ++i) {
    if (i == face) continue;
    for (const float value : std::as_const(after.model).face_logits(i))
      ASSERT_TRUE(std::isfinite(value));
  }
  for (const float value : floats(after.model.positions)) ASSERT_TRUE(std::isfinite(value));
  for (const float value : after.model.mlp) ASSERT_TRUE(std::isfinite(value));
}

void expect_same_training(const MakeBackend& make, int steps) {
  // A learnable target: images of another soup on a white background.
  Fixture fixture(11, {.faces = 80, .min_level = 0, .max_level = 2}, 48, 40, 6);
  {
    const Fixture other(12, {.faces = 60, .min_level = 0, .max_level = 2}, 48, 40, 0);
    const auto painter = make_cpu_backend(fixture.views, fixture.config, 1);
    painter->upload(other.state);
    for (TrainingView& view : fixture.views) {
      const std::vector<float> image = painter->render(view.camera);
      for (std::size_t i = 0; i < image.size(); ++i)
        view.target[i] = std::uint8_t(std::lround(255 * std::clamp(image[i], 0.0f, 1.0f)));
    }
  }
  const auto psnr = [&](Backend& backend) {
    backend.upload(fixture.state);
    for (int step = 0; step < steps; ++step) {
      const auto first = std::uint32_t(step) % 3;
      const std::uint32_t batch[] = {first, first + 3};
      backend.step(batch, rates);
    }
    double squared = 0, count = 0;
    for (const TrainingView& view : fixture.views) {
      const std::vector<float> image = backend.render(view.camera);
      for (std::size_t i = 0; i < image.size(); ++i) {
        const double d = double(image[i]) - view.target[i] / 255.0;
        squared += d * d;
      }
      count += double(image.size());
    }
    return -10 * std::log10(squared / count);
  };
  const auto actual = make(fixture.views, fixture.config);
  const auto expected = make_cpu_backend(fixture.views, fixture.config, 1);
  const double expected_psnr = psnr(*expected), actual_psnr = psnr(*actual);
  std::cout << "PSNR " << actual_psnr << " dB, on the processor " << expected_psnr << " dB\n";
  EXPECT_GT(expected_psnr, 10);
  EXPECT_NEAR(actual_psnr, expected_psnr, 0.2);
}

}  // namespace tureen::trainer::test
