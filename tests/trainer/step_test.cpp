// Whole steps of the processor's backend: its gradient compared with finite differences of an
// image's loss in double, identical bits with any number of threads, and non-finite numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"
#include "scene/triangle_soup.hpp"
#include "tests/support/random.hpp"
#include "tests/trainer/random_model.hpp"
#include "tests/trainer/ray_triangle.hpp"
#include "tests/trainer/stages.hpp"
#include "trainer/common/cpu/image_loss.hpp"
#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/kernels/color_network.hpp"
#include "trainer/diffsoup/levels.hpp"

namespace tureen::trainer {
namespace step_test {

using tureen::test::Random;

constexpr int width = 40, height = 33;

// Cameras around the model, each with an image of noise.
std::vector<TrainingView> random_views(std::uint64_t seed, int count, const glm::dvec3& middle) {
  Random random(seed);
  std::vector<TrainingView> views;
  for (int i = 0; i < count; ++i) {
    TrainingView view;
    view.camera = look_at(middle + 5.0 * random.direction(), middle, {0, 0, 1}, 0.9, width, height);
    view.camera.cx += random.uniform(-4, 4);
    view.target.resize(3 * width * height);
    for (std::uint8_t& byte : view.target) byte = std::uint8_t(random.below(256));
    views.push_back(std::move(view));
  }
  return views;
}

TrainingState random_state(std::uint64_t seed, std::size_t faces, int min_level, int max_level) {
  TrainingState state;
  state.model = test::random_model(
      seed,
      {.faces = faces, .min_level = min_level, .max_level = max_level, .logit_deviation = 1.0});
  state.moments.reset_faces(state.model);
  return state;
}

// Every draw accepts the fragments, so the loss is differentiable.
void make_opaque(Model& model) {
  const std::size_t coarse = lattice::texel_count(model.min_level);
  for (std::size_t face = 0; face < model.faces(); ++face) {
    const std::span<float> logits = model.face_logits(face);
    for (std::size_t texel = 0; texel * channels < logits.size(); ++texel)
      logits[texel * channels + alpha_channel] = texel < coarse ? 20.0f : 0.0f;
  }
}

constexpr Rates rates = {.texture = 5e-2f, .mlp = 1e-2f, .vertex = 1e-3f};

// The loss of a model by its formulas in double, for given faces and barycentrics of pixels.
class ReferenceLoss {
 public:
  ReferenceLoss(const Model& model, const TrainingView& view, const Config& config)
      : view_(view), config_(config), geometry_(view_of(view.camera, model.origin, 0.01, 100)) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) pixels_.push_back(nearest(model, x, y));
  }

  double operator()(const Model& model, const std::vector<double>& logits,
                    const std::vector<double>& mlp) const {
    constexpr std::size_t pixels = std::size_t(width) * height;
    std::vector<double> color(3 * pixels), gradient(3 * pixels);
    for (std::size_t p = 0; p < pixels; ++p) {
      const Pixel& pixel = pixels_[p];
      double rgb[3] = {config_.background[0], config_.background[1], config_.background[2]};
      if (pixel.face != no_face) {
        kernels::NetworkState<double> state;
        features(model, logits, pixel, state.input);
        const auto column = p % width, row = p / width;
        const glm::dvec3 to_eye =
            -glm::normalize(test::ray(geometry_, double(column), double(row)));
        const auto basis = harmonics::basis(to_eye);
        std::copy_n(basis.begin(), 9, state.input + kernels::features);
        kernels::shade(mlp.data(), state, rgb);
      }
      for (std::size_t c = 0; c < 3; ++c) color[c * pixels + p] = rgb[c];
    }
    ImageLossScratch<double> scratch;
    ThreadPool pool(1);
    return image_loss(ImageLossView<double>{.width = width,
                                            .height = height,
                                            .rendered = color,
                                            .target = view_.target,
                                            .ignored = {},
                                            .l1_weight = double(config_.l1_weight),
                                            .ssim_weight = double(config_.ssim_weight),
                                            .gradient = gradient,
                                            .pixel_loss = {}},
                      scratch, pool)
        .loss;
  }

  std::size_t covered() const {
    return std::size_t(
        std::ranges::count_if(pixels_, [](const Pixel& p) { return p.face != no_face; }));
  }

 private:
  struct Pixel {
    std::uint32_t face = no_face;
    double b0 = 0, b1 = 0;
  };

  Pixel nearest(const Model& model, int x, int y) const {
    Pixel pixel;
    double inverse_depth = 0;
    for (std::uint32_t face = 0; face < model.faces(); ++face) {
      const test::RayHit hit = test::intersect(geometry_, &model.positions[3 * face].x, x, y);
      if (!test::hits(hit, geometry_) || hit.inverse_depth <= inverse_depth) continue;
      inverse_depth = hit.inverse_depth;
      pixel = {face, hit.e[0] / inverse_depth, hit.e[1] / inverse_depth};
    }
    return pixel;
  }

  // Levels are summed at the fine texels, followed by the sigmoid and the interpolation.
  static void features(const Model& model, const std::vector<double>& logits, const Pixel& pixel,
                       double* out) {
    const auto fine = lattice::footprint(model.max_level, pixel.b0, pixel.b1);
    const double step = 1.0 / lattice::resolution(model.max_level);
    for (int f = 0; f < kernels::features; ++f) {
      out[f] = 0;
      for (std::size_t j = 0; j < 3; ++j) {
        const auto [x, y] = lattice::texel_coordinates(fine.texels[j]);
        std::size_t begin = pixel.face * model.texels();
        double sum = 0;
        for (int level = model.min_level; level <= model.max_level; ++level) {
          const auto at = lattice::footprint(level, x * step, y * step);
          for (std::size_t k = 0; k < 3; ++k)
            sum += at.weights[k] * logits[(begin + at.texels[k]) * channels + std::size_t(f)];
          begin += lattice::texel_count(level);
        }
        out[f] += fine.weights[j] / (1 + std::exp(-sum));
      }
    }
  }

  const TrainingView& view_;
  const Config& config_;
  kernels::View geometry_;
  std::vector<Pixel> pixels_;
};

TEST(CpuStep, ItsGradientIsThatOfTheLoss) {
  for (const auto& [min_level, max_level] : {std::pair(0, 0), std::pair(0, 2), std::pair(1, 3)}) {
    SCOPED_TRACE("levels " + std::to_string(min_level) + " to " + std::to_string(max_level));
    TrainingState state = random_state(21, 15, min_level, max_level);
    make_opaque(state.model);
    const auto views = random_views(22, 1, state.model.origin);
    Config config;
    config.beta1 = 0;  // the first moment is then the gradient
    const auto backend = make_cpu_backend(views, config, 2);
    backend->upload(state);
    const std::uint32_t batch[] = {0};
    const StepReport report = backend->step(batch, rates);
    TrainingState after;
    backend->download(after);

    const ReferenceLoss loss(state.model, views[0], config);
    ASSERT_GT(loss.covered(), 300u);
    std::vector<double> logits(state.model.logits.begin(), state.model.logits.end());
    std::vector<double> mlp(state.model.mlp.begin(), state.model.mlp.end());
    EXPECT_NEAR(report.loss, loss(state.model, logits, mlp), 1e-5);
    EXPECT_EQ(report.non_finite, 0u);

    // Differences with h = 1e-5 have errors of 1e-10 of the loss; gradients of texels are about
    // 1e-4. |C - G| has its kink at a byte's value: close in few of 1320 x 3 values, and never
    // within 1e-5.
    constexpr double h = 1e-5;
    const auto difference = [&](double& number) {
      const double kept = number;
      number = kept + h;
      const double plus = loss(state.model, logits, mlp);
      number = kept - h;
      const double minus = loss(state.model, logits, mlp);
      number = kept;
      return (plus - minus) / (2 * h);
    };
    const auto largest = [](const auto& gradient) {
      double result = 0;
      for (const float g : gradient) result = std::max(result, std::abs(double(g)));
      return result;
    };
    // Sums of hundreds of floats, and barycentrics with errors of about 1e-6: the bound is a
    // thousandth of each gradient, plus a thousandth of a hundredth of the largest.
    Random random(23);
    const double most = largest(after.moments.first);
    ASSERT_GT(most, 1e-5);
    int touched = 0;
    for (int trial = 0; trial < 150; ++trial) {
      const std::size_t i = random.below(std::uint32_t(logits.size()));
      const double expected =
          i % channels == alpha_channel ? 0 : difference(logits[i]);  // alpha is 1: no score
      touched += expected != 0;
      EXPECT_NEAR(double(after.moments.first[i]), expected,
                  1e-3 * (std::abs(expected) + 0.01 * most))
          << "logit " << i;
    }
    EXPECT_GT(touched, 30);
    const double max_mlp = largest(after.moments.mlp_first);
    for (std::size_t i = 0; i < mlp_parameters; i += 11) {
      const double expected = difference(mlp[i]);
      EXPECT_NEAR(double(after.moments.mlp_first[i]), expected,
                  1e-3 * (std::abs(expected) + 0.01 * max_mlp))
          << "parameter " << i;
    }
  }
}

/// For vectors and arrays.
template <class Values>
bool same_bits(const Values& a, const Values& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

bool same_bits(const TrainingState& a, const TrainingState& b) {
  const Moments &m = a.moments, &n = b.moments;
  return same_bits(a.model.positions, b.model.positions) &&
         same_bits(a.model.logits, b.model.logits) && same_bits(a.model.mlp, b.model.mlp) &&
         same_bits(m.first, n.first) && same_bits(m.second, n.second) &&
         same_bits(m.vertex_first, n.vertex_first) && same_bits(m.vertex_second, n.vertex_second) &&
         m.steps == n.steps && same_bits(m.mlp_first, n.mlp_first) &&
         same_bits(m.mlp_second, n.mlp_second) && m.mlp_steps == n.mlp_steps &&
         same_bits(a.baseline, b.baseline) && same_bits(a.errors, b.errors) && a.step == b.step &&
         a.non_finite == b.non_finite;
}

TrainingState after_steps(const TrainingState& state, const std::vector<TrainingView>& views,
                          const Config& config, int threads, int steps) {
  const auto backend = make_cpu_backend(views, config, threads);
  backend->upload(state);
  for (int step = 0; step < steps; ++step) {
    const std::uint32_t batch[] = {std::uint32_t(step) % 4, std::uint32_t(step + 1) % 4};
    backend->step(batch, rates);
  }
  TrainingState result;
  backend->download(result);
  return result;
}

TEST(CpuStep, GivesTheSameBitsWithAnyNumberOfThreads) {
  const TrainingState state = random_state(31, 300, 1, 2);
  const auto views = random_views(32, 4, state.model.origin);
  const TrainingState one = after_steps(state, views, Config{}, 1, 5);
  EXPECT_EQ(one.step, 5);
  EXPECT_FALSE(same_bits(one.model.logits, state.model.logits));
  EXPECT_FALSE(same_bits(one.model.positions, state.model.positions));
  for (const int threads : {2, 3})
    EXPECT_TRUE(same_bits(one, after_steps(state, views, Config{}, threads, 5))) << threads;
  // Another seed gives other results, so the draws have an effect.
  Config other;
  other.seed = 1;
  EXPECT_FALSE(same_bits(one, after_steps(state, views, other, 1, 5)));
}

TEST(CpuStep, GoesOnFromASavedState) {
  const TrainingState state = random_state(33, 100, 0, 1);
  const auto views = random_views(34, 4, state.model.origin);
  const auto backend = make_cpu_backend(views, Config{}, 2);
  const std::uint32_t batch[] = {1, 3};
  backend->upload(state);
  for (int step = 0; step < 2; ++step) backend->step(batch, rates);
  TrainingState saved, straight, resumed;
  backend->download(saved);
  for (int step = 0; step < 2; ++step) backend->step(batch, rates);
  backend->download(straight);
  const auto another = make_cpu_backend(views, Config{}, 1);
  another->upload(saved);
  for (int step = 0; step < 2; ++step) another->step(batch, rates);
  another->download(resumed);
  EXPECT_TRUE(same_bits(straight, resumed));
}

// Expects that everything is finite except the data of `skipped_face`.
void expect_finite(const TrainingState& state, std::size_t skipped_face) {
  const std::size_t face_logits = state.model.texels() * channels;
  const auto finite = [&](const auto& values, std::size_t a_face, const char* what) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (i / a_face != skipped_face) {
        ASSERT_TRUE(std::isfinite(values[i])) << what << " " << i;
      }
  };
  finite(state.model.logits, face_logits, "logit");
  finite(state.moments.first, face_logits, "first moment");
  finite(state.moments.second, face_logits, "second moment");
  finite(std::span(&state.model.positions[0].x, 3 * state.model.positions.size()), 9, "position");
  finite(state.moments.vertex_second, 3, "second moment of vertex");
  for (const MlpParameters* all :
       {&state.model.mlp, &state.moments.mlp_first, &state.moments.mlp_second})
    for (const float number : *all) ASSERT_TRUE(std::isfinite(number));
}

class ATexelThatIsNoNumber : public testing::TestWithParam<int> {};  // the channel

TEST_P(ATexelThatIsNoNumber, IsCountedAndDoesNotSpread) {
  // docs/numerics.md, O5. A wall that is visible in many pixels, with other faces in front of it
  // and beside it.
  constexpr std::size_t bad_face = 40;
  TrainingState state = random_state(41, 80, 0, 1);
  const auto views = random_views(42, 4, state.model.origin);
  for (int k = 0; k < 3; ++k) state.model.positions[3 * bad_face + std::size_t(k)] *= 2.0f;
  TrainingState bad = state;
  bad.model.face_logits(bad_face)[std::size_t(GetParam())] =
      std::numeric_limits<float>::quiet_NaN();
  const TrainingState after = after_steps(bad, views, Config{}, 2, 4);
  EXPECT_GT(after.non_finite, 0u);
  expect_finite(after, bad_face);
  // Everything else continues to learn, including the network.
  EXPECT_EQ(after.moments.mlp_steps, 4u);
  EXPECT_NE(after.model.mlp, bad.model.mlp);
  std::size_t moved = 0, seen = 0;
  for (std::size_t face = 0; face < 80; ++face) {
    seen += face != bad_face && after.moments.steps[face] > 0;
    moved += face != bad_face && after.model.positions[3 * face] != bad.model.positions[3 * face];
  }
  EXPECT_GT(seen, 50u);
  EXPECT_GT(moved, seen * 9 / 10);  // some are never accepted in four steps
  // The same without the bad texel: nothing is counted.
  EXPECT_EQ(after_steps(state, views, Config{}, 2, 4).non_finite, 0u);
}

INSTANTIATE_TEST_SUITE_P(InChannel, ATexelThatIsNoNumber, testing::Values(0, 3, 5, alpha_channel),
                         testing::PrintToStringParamName());

TEST(CpuStep, WhatDoesNotCountLeavesTheBaselineAlone) {
  // A wall behind everything, with NaN as its blend between base colour and network. Its pixels are
  // excluded, and their running means do not change. The same holds for pixels that the caller
  // ignores.
  TrainingState state = random_state(45, 1, 0, 0);
  make_opaque(state.model);
  state.model.origin = glm::dvec3(0.0);
  state.model.positions = {{-50, -50, -3}, {50, -50, -3}, {0, 50, -3}};
  state.model.logits[blend_channel] = std::numeric_limits<float>::quiet_NaN();
  constexpr std::size_t pixels = std::size_t(width) * height;
  for (const bool named : {false, true}) {
    TrainingView view{.camera = test::axis_camera(width, height, 40), .target = {}, .ignored = {}};
    view.target.assign(3 * pixels, 100);
    TrainingState before = state;
    if (named) {
      before.model.logits[blend_channel] = 0;
      view.ignored.assign(pixels, 1);
    }
    before.baseline.assign(pixels, 30000);
    const std::vector<TrainingView> views = {view};
    const auto backend = make_cpu_backend(views, Config{}, 1);
    backend->upload(before);
    const std::uint32_t batch[] = {0};
    const StepReport report = backend->step(batch, rates);
    if (!named) {
      EXPECT_GE(report.non_finite, pixels);
    }
    TrainingState after;
    backend->download(after);
    EXPECT_EQ(after.baseline, before.baseline) << named;
  }
}

TEST(CpuStep, APositionThatIsNoNumberDoesNotSpread) {
  TrainingState state = random_state(43, 60, 0, 1);
  const auto views = random_views(44, 4, state.model.origin);
  state.model.positions[3 * 7 + 1].y = std::numeric_limits<float>::quiet_NaN();
  state.model.positions[3 * 9].x = std::numeric_limits<float>::infinity();
  const TrainingState after = after_steps(state, views, Config{}, 2, 4);
  EXPECT_EQ(after.moments.steps[7], 0u);
  EXPECT_EQ(after.moments.steps[9], 0u);
  for (const std::size_t face : {7u, 9u})
    for (std::size_t k = 0; k < 3; ++k) state.model.positions[3 * face + k] = glm::vec3(0);
  TrainingState cleared = after;
  for (const std::size_t face : {7u, 9u})
    for (std::size_t k = 0; k < 3; ++k) cleared.model.positions[3 * face + k] = glm::vec3(0);
  expect_finite(cleared, ~std::size_t(0));
}

TEST(CpuStep, AGradientWhoseSquareIsInfiniteIsSkipped) {
  // With an infinite second moment, a parameter would never move again.
  test::Faces faces({{-2, -2, -2}, {2, -2, -2}, {0, 3, -2}});
  std::vector<BatchImage> images{test::make_image(test::axis_camera(32, 32, 32))};
  faces.find(images[0], Masking::threshold);
  images[0].features[16 * 32 + 16].values[0] = 1e25f;
  EXPECT_EQ(faces.gather(images, 0), 1u);
  for (const float second : faces.moments.second) EXPECT_EQ(second, 0);
  for (const float logit : faces.model.logits) EXPECT_TRUE(std::isfinite(logit));
}

TEST(CpuStep, WhatNoImageShowsStaysAsItIs) {
  TrainingState state = random_state(51, 20, 0, 1);
  const auto views = random_views(52, 4, state.model.origin);
  // Far behind everything in view, beyond the far plane.
  for (std::size_t k = 0; k < 3; ++k) state.model.positions[3 * 5 + k] += glm::vec3(1e4f, 0, 0);
  for (const bool dense : {false, true}) {
    Config config;
    config.dense_updates = dense;
    // With earlier moments, so that a dense step moves the face.
    TrainingState before = state;
    std::ranges::fill(before.moments.first, 0.1f);
    std::ranges::fill(before.moments.second, 0.1f);
    std::ranges::fill(before.moments.steps, 10u);
    const TrainingState after = after_steps(before, views, config, 1, 3);
    const std::span<const float> old_logits = before.model.face_logits(5);
    const std::span<const float> new_logits = after.model.face_logits(5);
    EXPECT_EQ(std::ranges::equal(old_logits, new_logits), !dense);
    EXPECT_EQ(after.moments.steps[5], dense ? 13u : 10u);
  }
}

TEST(CpuRender, ShowsWhatTheFormulasSay) {
  TrainingState state = random_state(61, 30, 0, 2);
  make_opaque(state.model);
  const auto views = random_views(62, 1, state.model.origin);
  const auto backend = make_cpu_backend(views, Config{}, 2);
  backend->upload(state);
  std::vector<float> image = backend->render(views[0].camera);
  // With targets of 0 and without SSIM, the loss is the mean of the image.
  TrainingView black = views[0];
  std::ranges::fill(black.target, std::uint8_t(0));
  Config config;
  config.l1_weight = 1;
  config.ssim_weight = 0;
  const ReferenceLoss mean(state.model, black, config);
  double sum = 0;
  for (const float value : image) sum += double(value) / double(image.size());
  const std::vector<double> logits(state.model.logits.begin(), state.model.logits.end());
  const std::vector<double> mlp(state.model.mlp.begin(), state.model.mlp.end());
  EXPECT_NEAR(sum, mean(state.model, logits, mlp), 1e-5);
  std::uint64_t pixels = 0;
  for (const std::uint64_t count : backend->visible_pixels({&views[0].camera, 1})) pixels += count;
  EXPECT_EQ(pixels, mean.covered());
}

}  // namespace step_test
}  // namespace tureen::trainer
