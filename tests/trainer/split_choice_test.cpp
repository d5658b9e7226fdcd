#include "trainer/diffsoup/split_choice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <vector>

#include "tests/trainer/random_model.hpp"

namespace tureen::trainer {
namespace split_choice_test {

using test::random_model;
using testing::IsEmpty;
using testing::SizeIs;

double longest_edge(const Model& model, std::size_t face) {
  double longest = 0;
  for (int edge = 0; edge < 3; ++edge)
    longest =
        std::max(longest, glm::distance(glm::dvec3(model.positions[3 * face + edge]),
                                        glm::dvec3(model.positions[3 * face + (edge + 1) % 3])));
  return longest;
}

// Compared with a simple method: search all faces before each split.
TEST(LongestEdges, AreBisectedUntilTheBudgetIsMet) {
  for (const std::size_t budget : {0u, 10u, 11u, 57u}) {
    const Model model = random_model(61, {.faces = 10, .max_level = 0});
    const Resampled result = split(model, longest_edges(model, budget), ChildTexture::copied);
    Model slow = model;
    while (slow.faces() < budget) {
      Split next{.face = 0, .edge = 0, .t = 0.5f};
      double longest = -1;
      for (std::uint32_t face = 0; face < slow.faces(); ++face)
        for (int edge = 0; edge < 3; ++edge) {
          const double length =
              glm::distance(glm::dvec3(slow.positions[3 * face + edge]),
                            glm::dvec3(slow.positions[3 * face + (edge + 1) % 3]));
          if (length > longest) longest = length, next.face = face, next.edge = edge;
        }
      slow = split(slow, std::span(&next, 1), ChildTexture::copied).model;
    }
    EXPECT_EQ(result.model.faces(), std::max<std::size_t>(budget, 10));
    EXPECT_EQ(result.model.positions, slow.positions) << budget;
  }
}

TEST(LongestEdges, EndWithFacesOfNoSizeOrNumber) {
  Model model = random_model(62, {.faces = 2, .max_level = 0});
  for (glm::vec3& position : model.positions) position = glm::vec3(1.0f);
  model.positions[0].x = std::nanf("");
  EXPECT_THAT(longest_edges(model, 50), SizeIs(48));
  EXPECT_THAT(longest_edges(random_model(62, {.faces = 0}), 50), IsEmpty());
}

// Compared with a simple method, as above.
TEST(GreatestErrors, AreHalvedUntilTheBudgetIsMet) {
  const Model model = random_model(63, {.faces = 8, .max_level = 0});
  std::vector<float> errors;
  for (int i = 0; i < 8; ++i) errors.push_back(float(1 + (5 * i) % 8));  // all different
  for (const std::size_t budget : {0u, 8u, 9u, 40u}) {
    const Resampled result =
        split(model, greatest_errors(model, errors, budget), ChildTexture::copied);
    Model slow = model;
    std::vector<double> left(errors.begin(), errors.end());
    while (slow.faces() < budget) {
      const auto worst = std::max_element(left.begin(), left.end()) - left.begin();
      Split next{.face = std::uint32_t(worst), .edge = 0, .t = 0.5f};
      double longest = -1;
      for (int edge = 0; edge < 3; ++edge) {
        const double length =
            glm::distance(glm::dvec3(slow.positions[3 * std::size_t(worst) + edge]),
                          glm::dvec3(slow.positions[3 * std::size_t(worst) + (edge + 1) % 3]));
        if (length > longest) longest = length, next.edge = edge;
      }
      slow = split(slow, std::span(&next, 1), ChildTexture::copied).model;
      left[std::size_t(worst)] /= 2;
      left.push_back(left[std::size_t(worst)]);
    }
    EXPECT_EQ(result.model.faces(), std::max<std::size_t>(budget, 8));
    EXPECT_EQ(result.model.positions, slow.positions) << budget;
  }
}

TEST(GreatestErrors, OfZeroStillMeetTheBudget) {
  const Model model = random_model(64, {.faces = 3, .max_level = 0});
  EXPECT_THAT(greatest_errors(model, std::vector<float>(3), 20), SizeIs(17));
}

// Without errors, the longest edges are split: no single face uses the whole budget.
TEST(GreatestErrors, OfZeroGoByLength) {
  const Model model = random_model(65, {.faces = 12, .max_level = 0});
  const std::vector<float> none(12);
  const auto positions = [&](const std::vector<Split>& splits) {
    return split(model, splits, ChildTexture::copied).model.positions;
  };
  EXPECT_EQ(positions(greatest_errors(model, none, 90)), positions(longest_edges(model, 90)));
  // Any face with an error comes first.
  std::vector<float> one = none;
  one[7] = 1e-20f;
  for (const Split& each : greatest_errors(model, one, 20))
    EXPECT_TRUE(each.face == 7 || each.face >= 12) << each.face;
}

TEST(Splits, LeaveTheFirstFacesWhole) {
  const Model model = random_model(66, {.faces = 12, .max_level = 0});
  const std::vector<float> errors{9, 9, 9, 9, 9, 1, 1, 1, 1, 1, 0, 0};
  for (const std::vector<Split>& splits :
       {longest_edges(model, 60, 5), greatest_errors(model, errors, 60, 5)}) {
    EXPECT_THAT(splits, SizeIs(48));
    for (const Split& each : splits) EXPECT_GE(each.face, 5u);
  }
}

/// A camera at the origin that looks along -z: at depth 1, the image of 200 x 100 pixels is 2 x 1
/// units.
Camera plain_camera() {
  return {.name = "",
          .width = 200,
          .height = 100,
          .fx = 100,
          .fy = 100,
          .cx = 100,
          .cy = 50,
          .view_from_world = glm::dmat4(1.0)};
}

Model triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  Model model = random_model(63, {.faces = 1, .max_level = 0});
  model.origin = glm::dvec3(0.0);
  model.positions = {a, b, c};
  return model;
}

std::vector<Split> choose(const Model& model, double fraction, std::size_t budget) {
  const std::vector<std::uint8_t> visible(model.faces(), 1);
  const SplitView view{.camera = plain_camera(), .visible = visible};
  return longest_projected_edges(model, std::span(&view, 1),
                                 {.fraction = fraction, .budget = budget, .near = 0.1});
}

TEST(LongestProjectedEdges, AreHalvedInTheImage) {
  // Corners project to (20, 50), (180, 50), (100, 90), at depths 1, 4 and 2.
  const Model model = triangle({-0.8f, 0, -1}, {3.2f, 0, -4}, {0, -0.8f, -2});
  const std::vector<Split> splits = choose(model, 0.2, 2);
  ASSERT_THAT(splits, SizeIs(1));
  EXPECT_EQ(splits[0].face, 0u);
  EXPECT_EQ(splits[0].edge, 0);
  EXPECT_FLOAT_EQ(splits[0].t, 1.0f / 5.0f);  // 1 / (1 + 4): close to the nearer end
  const Resampled result = split(model, splits, ChildTexture::copied);
  const glm::vec3 point = result.model.positions[1];
  EXPECT_NEAR(100 + 100 * point.x / -point.z, 100, 1e-4);  // between 20 and 180 pixels
}

TEST(LongestProjectedEdges, StopAtTheThreshold) {
  // Edges of 40, 50 and 30 pixels in an image 100 pixels high.
  const Model model = triangle({0, 0, -1}, {0.4f, 0, -1}, {0, 0.3f, -1});
  EXPECT_THAT(choose(model, 0.51, 100), IsEmpty());
  EXPECT_THAT(choose(model, 0.45, 100), SizeIs(1));  // halves of 25, 30 or 40, and a median of 25
  // In the end, no edge is longer than the threshold.
  const Model all = split(model, choose(model, 0.1, 1000), ChildTexture::copied).model;
  EXPECT_GT(all.faces(), 10u);
  for (std::size_t face = 0; face < all.faces(); ++face)
    EXPECT_LE(longest_edge(all, face) * 100, 10 * (1 + 1e-5));  // at depth 1; positions are floats
}

TEST(LongestProjectedEdges, KeepTheBudgetAndTakeTheLongestFirst) {
  Model model = random_model(64, {.faces = 50, .max_level = 0});
  for (glm::vec3& position : model.positions) position.z -= 6;
  model.origin = glm::dvec3(0.0);
  const std::vector<Split> all = choose(model, 0.02, 100000);
  ASSERT_GT(all.size(), 200u);
  for (const std::size_t budget : {0u, 50u, 51u, 120u}) {
    const std::vector<Split> some = choose(model, 0.02, budget);
    ASSERT_THAT(some, SizeIs(budget < 50 ? 0 : budget - 50));
    for (std::size_t i = 0; i < some.size(); ++i) {
      EXPECT_EQ(some[i].face, all[i].face);
      EXPECT_EQ(some[i].edge, all[i].edge);
      EXPECT_EQ(some[i].t, all[i].t);
    }
  }
}

TEST(LongestProjectedEdges, OnlyOfVisibleFacesAndTheirChildren) {
  Model model = random_model(65, {.faces = 2, .max_level = 0});
  model.origin = glm::dvec3(0.0);
  for (int corner = 0; corner < 3; ++corner)  // two copies of the same face
    model.positions[3 + corner] = model.positions[corner] -= glm::vec3(0, 0, 6);
  const std::vector<std::uint8_t> visible = {0, 1}, none = {0, 0};
  const std::vector<SplitView> views = {{.camera = plain_camera(), .visible = none},
                                        {.camera = plain_camera(), .visible = visible}};
  const ProjectedSplits rule{.fraction = 0.05, .budget = 1000, .near = 0.1};
  EXPECT_THAT(longest_projected_edges(model, std::span(views).first(1), rule), IsEmpty());
  const std::vector<Split> splits = longest_projected_edges(model, views, rule);
  ASSERT_GT(splits.size(), 3u);
  for (const Split& one : splits) EXPECT_NE(one.face, 0u);
}

TEST(LongestProjectedEdges, CountByThePartInTheImage) {
  // From pixel 150 far outside to the right; the third corner is outside the image, too.
  const Model out = triangle({0.5f, 0, -1}, {100, 0, -1}, {100, 1, -1});
  const std::vector<Split> splits = choose(out, 0.2, 2);
  ASSERT_THAT(splits, SizeIs(1));
  const glm::vec3 point =
      split(out, splits, ChildTexture::copied).model.positions[(splits[0].edge + 1) % 3];
  // Pixels 150 to 200 are halved at 175: 0.75 at depth 1. (The third edge rises half a pixel.)
  EXPECT_NEAR(point.x, 0.75, 0.01);

  // From in front of the camera to behind it, below the axis. It is visible beyond the near plane
  // and inside the image: y = -0.4 at depths of at least 0.8.
  const Model through = triangle({0, -0.4f, -4}, {0, -0.4f, 4}, {0.01f, -0.4f, -4});
  ASSERT_THAT(choose(through, 0.2, 2), SizeIs(1));
  const Split cut = choose(through, 0.2, 2)[0];
  const double depth = glm::abs(split(through, std::span(&cut, 1), ChildTexture::copied)
                                    .model.positions[(cut.edge + 1) % 3]
                                    .z);
  // Depth 4 is 10 pixels below the axis, the border 50 pixels. The middle, 30 pixels, is at depth
  // 4/3.
  EXPECT_NEAR(depth, 4.0 / 3.0, 1e-4);

  // Behind the camera, and beside the image: nothing to split.
  EXPECT_THAT(choose(triangle({-5, 0, 1}, {5, 0, 1}, {0, 5, 2}), 0.01, 100), IsEmpty());
  EXPECT_THAT(choose(triangle({5, -9, -1}, {5, 9, -1}, {9, 0, -1}), 0.01, 100), IsEmpty());
  // Across the whole image with every corner outside: the published code never splits it.
  EXPECT_THAT(choose(triangle({-9, 0.1f, -1}, {9, 0.1f, -1}, {0, -9, -1}), 0.5, 2), SizeIs(1));
}

TEST(LongestProjectedEdges, EndWhateverThePerspective) {
  const Model model = triangle({0, -0.1f, -0.1001f}, {1e6f, -1e6f, -1e7f}, {std::nanf(""), 0, -1});
  EXPECT_LE(choose(model, 0.01, 5000).size(), 4999u);
}

}  // namespace split_choice_test
}  // namespace tureen::trainer
