// Stochastic masking: cases S1 to S5.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "tests/numerics/recorder.hpp"
#include "tests/numerics/scenes.hpp"
#include "tests/support/random.hpp"
#include "tests/trainer/fragments.hpp"
#include "tests/trainer/stages.hpp"
#include "trainer/common/kernels/random.hpp"
#include "trainer/common/kernels/score.hpp"

namespace tureen::test {
namespace masking_test {

using trainer::kernels::FragmentRole;
using trainer::kernels::logit_score;

float logit_of(double alpha) {
  return alpha <= 0 ? -200.0f : alpha >= 1 ? 200.0f : float(std::log(alpha / (1 - alpha)));
}

/// Allowed error of a mean of hundreds of draws or more, in standard errors. A normal deviate
/// exceeds it once in 16,000 times. Seeds are fixed, so results repeat.
constexpr double max_standard_errors = 4;

struct Moments {
  double sum = 0, squares = 0;
  int count = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  double mean() const { return sum / count; }
  double deviation() const { return std::sqrt(std::max(squares / count - mean() * mean(), 0.0)); }
  double standard_error() const { return deviation() / std::sqrt(double(count)); }
};

TEST(Numerics, S1_TheScoreStaysBoundedForEveryOpacity) {
  Recorder recorder({.stressed = "scatter of one draw's gradient by opacity: the score by the "
                                 "logit, with the trainer's draws",
                     .parameter = "1 - alpha (0 is plotted at 1e-9)",
                     .unit = "standard deviation for a loss of 0 or 1",
                     .naive = "the score by alpha, 1 / alpha and 1 / (1 - alpha)"});
  for (const double alpha : {0.0, 1e-7, 0.1, 0.5, 0.9, 0.99, 0.999, 0.9999, 1 - 1e-7, 1.0}) {
    const auto a = float(alpha);
    // Within 2^-23 of an alpha of 1, draws are rarely lost; this many draws contain some. At 1 no
    // draw is lost, and the naive method, which would divide by 0 for a lost draw, does not scatter
    // either.
    const int draws = a < 1 && 1 - a < 0x1p-20f ? 1 << 26 : 1 << 20;
    Moments by_logit, by_alpha;
    for (int i = 0; i < draws; ++i) {
      // A loss of 1 where the fragment does not show: E = 1 - alpha, dE/dlogit = -alpha (1 -
      // alpha).
      const bool won = a >= trainer::kernels::uniform_draw(1, std::uint32_t(i), 0);
      const double loss = won ? 0 : 1;
      by_logit.add(loss * double(logit_score(won ? FragmentRole::winner : FragmentRole::in_front, a,
                                             1.0f, a)));
      by_alpha.add(loss * (won ? 1 / double(a) : -1 / (1 - double(a))));
    }
    const double truth = -double(a) * (1 - double(a));
    // Draws are multiples of 2^-24, which limits the precision of a probability. An event rarer
    // than once in all these draws is not seen. Both change whether a fragment shows, which changes
    // the score by alpha. Next to alpha = 1, where one draw in 2^23 is lost, this bounds the mean
    // but does not determine its sign; next to 0 it does.
    EXPECT_NEAR(by_logit.mean(), truth,
                max_standard_errors * by_logit.standard_error() + a * (0x1p-24 + 1.0 / draws))
        << alpha;
    // |score| <= 1, and so is the loss.
    recorder.add({.at = std::max(1 - alpha, 1e-9),  // the plot's axis has no 0
                  .naive = by_alpha.deviation(),
                  .ours = by_logit.deviation(),
                  .tolerance = 1});
  }
}

TEST(Numerics, S2_NothingShowsAtAnAlphaOfZero) {
  Recorder recorder({.stressed = "draws that accept an alpha of 0, or reject an alpha of 1",
                     .parameter = "draws",
                     .unit = "wrong draws",
                     .naive = "uniform numbers of [0, 1)"});
  double ours = 0, naive = 0;
  std::uint32_t next = 0;
  for (const std::uint32_t draws : {1u << 20, 1u << 24, 1u << 26}) {
    for (; next < draws; ++next) {
      const float u = trainer::kernels::uniform_draw(2, next, 5);
      ours += !(u > 0) + !(u <= 1);
      naive += 0.0f >= u - 0x1p-24f;  // the same bits, before 2^-24 is added
    }
    recorder.add({.at = double(draws), .naive = naive, .ours = ours, .tolerance = 0});
  }
}

std::vector<glm::vec3> random_faces(Random& random, int count) {
  std::vector<glm::vec3> corners;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 middle(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-4, -1.5));
    for (int k = 0; k < 3; ++k) corners.emplace_back(middle + 0.5 * random.direction());
  }
  return corners;
}

TEST(Numerics, S3_DrawsDoNotDependOnTheOrderOfFragments) {
  Recorder recorder({.stressed = "the same image with tiles and faces in another order",
                     .parameter = "faces",
                     .unit = "of 9216 pixels show another face",
                     .naive = "numbers from a generator in the order of fragments"});
  constexpr int side = 96;
  const Camera camera = straight_camera(side, side, side);
  Random random(3);
  for (const int count : {10, 100, 1000}) {
    const std::vector<glm::vec3> corners = random_faces(random, count);
    const trainer::test::Faces faces(corners, 0.0f);
    trainer::BatchImage forwards = trainer::test::make_image(camera);
    forwards.draw_key = trainer::kernels::draw_key(3, 1, 0);
    trainer::BatchImage backwards = forwards;
    faces.find(forwards, trainer::Masking::stochastic);
    trainer::bin_faces(backwards, faces.model);
    for (std::size_t tile = 0; tile + 1 < backwards.bin_begin.size(); ++tile)
      std::reverse(backwards.bins.begin() + backwards.bin_begin[tile],
                   backwards.bins.begin() + backwards.bin_begin[tile + 1]);
    // Skipping hidden faces needs the order from front to back.
    std::ranges::fill(backwards.nearest, std::numeric_limits<float>::infinity());
    for (std::size_t tile = backwards.bin_begin.size() - 1; tile-- > 0;)
      trainer::find_visible(backwards, tile, faces.store.alpha.data(), 0,
                            trainer::Masking::stochastic);
    double ours = 0;
    for (std::size_t i = 0; i < forwards.visible.size(); ++i)
      ours += forwards.visible[i].face != backwards.visible[i].face;
    const auto by_generator = [&](bool reversed) {
      Random generator(4);
      std::vector<std::uint32_t> shown(side * side, no_face);
      std::vector<float> nearest(side * side);
      for (int i = 0; i < count; ++i) {
        const auto face = std::uint32_t(reversed ? count - 1 - i : i);
        trainer::test::for_each_fragment(
            forwards.view, forwards.projected[face], {0, 0, side, side},
            [&](const trainer::kernels::Fragment& f) {
              const auto at = std::size_t(f.y) * side + f.x;
              if (!generator.chance(0.5) || f.inverse_depth <= nearest[at]) return;
              nearest[at] = f.inverse_depth;
              shown[at] = face;
            });
      }
      return shown;
    };
    recorder.add({.at = double(count),
                  .naive = differing(by_generator(false), by_generator(true)),
                  .ours = ours,
                  .tolerance = 0});
  }
}

TEST(Numerics, S4_PixelsOfTheBackgroundTeachOpacity) {
  Recorder recorder({.stressed = "the gradient by opacity where a loss is on the background alone",
                     .parameter = "alpha",
                     .unit = "error of the mean of 400 steps in standard errors",
                     .naive = "only fragments that show have a gradient"});
  constexpr int side = 48, steps = 400;
  for (const double alpha : {0.1, 0.5, 0.9}) {
    trainer::test::Faces faces({{-9, -8, -2}, {9, -7, -2}, {0.5f, 12, -2.3f}}, logit_of(alpha));
    std::vector<trainer::BatchImage> images{
        trainer::test::make_image(straight_camera(side, side, side / 2.0))};
    trainer::BatchImage& image = images[0];
    Moments gradient, naive;
    for (int step = 0; step < steps; ++step) {
      image.draw_key = trainer::kernels::draw_key(4, std::uint32_t(step), 0);
      faces.find(image, trainer::Masking::stochastic);
      double winners = 0;
      for (std::size_t i = 0; i < image.visible.size(); ++i) {
        const bool background = image.visible[i].face == no_face;
        image.loss[i] = background ? 1.0f : 0.0f;
        winners += background ? 0 : double(image.loss[i]) / alpha;
      }
      faces.gather(images, 0);
      double sum = 0;
      for (std::size_t texel = 0; texel < 3; ++texel)
        sum += faces.by_logit(0, texel, trainer::alpha_channel);
      gradient.add(sum);
      naive.add(winners);
    }
    // The sum over the three texels is alpha's own derivative, summed over all pixels.
    const double truth = -alpha * (1 - alpha) * side * side;
    recorder.add({.at = alpha,
                  .naive = std::abs(naive.mean() - truth) / gradient.standard_error(),
                  .ours = std::abs(gradient.mean() - truth) / gradient.standard_error(),
                  .tolerance = max_standard_errors});
  }
}

TEST(Numerics, S5_LossAndScoreShareTheirDraw) {
  Recorder recorder({.stressed = "the gradient by opacity where pixels that show the face have a "
                                 "loss of 0.2, the others of 1",
                     .parameter = "alpha",
                     .unit = "error of the mean of 400 steps in standard errors",
                     .naive = "the loss of one draw with the score of another"});
  constexpr int side = 48, steps = 400;
  for (const double alpha : {0.1, 0.3, 0.5, 0.7, 0.9}) {
    trainer::test::Faces faces({{-9, -8, -2}, {9, -7, -2}, {0.5f, 12, -2.3f}}, logit_of(alpha));
    std::vector<trainer::BatchImage> images{
        trainer::test::make_image(straight_camera(side, side, side / 2.0))};
    trainer::BatchImage& image = images[0];
    const auto draw = [&](int number) {
      image.draw_key = trainer::kernels::draw_key(5, std::uint32_t(number), 0);
      faces.find(image, trainer::Masking::stochastic);
    };
    const auto take_loss = [&] {
      for (std::size_t i = 0; i < image.visible.size(); ++i)
        image.loss[i] = image.visible[i].face == no_face ? 1.0f : 0.2f;
    };
    const auto gathered = [&] {
      faces.gather(images, 0);
      double sum = 0;
      for (std::size_t texel = 0; texel < 3; ++texel)
        sum += faces.by_logit(0, texel, trainer::alpha_channel);
      return sum;
    };
    Moments same, other;
    for (int step = 0; step < steps; ++step) {
      draw(step);
      take_loss();
      same.add(gathered());
      draw(steps + step);  // with the loss of the previous draw
      other.add(gathered());
    }
    const double truth = (0.2 - 1) * alpha * (1 - alpha) * side * side;
    recorder.add({.at = alpha,
                  .naive = std::abs(other.mean() - truth) / other.standard_error(),
                  .ours = std::abs(same.mean() - truth) / same.standard_error(),
                  .tolerance = max_standard_errors});
  }
}

}  // namespace masking_test
}  // namespace tureen::test
