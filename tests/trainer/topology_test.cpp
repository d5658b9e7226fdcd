#include "trainer/diffsoup/topology.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "tests/trainer/random_model.hpp"

namespace tureen::trainer {
namespace topology_test {

using test::random_model;
using testing::Each;
using testing::ElementsAre;

/// Expects that face t of the result is face `from` of the model, bit by bit.
void expect_same_face(const Resampled& result, std::size_t t, const Model& model,
                      std::size_t from) {
  EXPECT_EQ(result.origin[t], from);
  for (int corner = 0; corner < 3; ++corner)
    EXPECT_EQ(result.model.positions[3 * t + corner], model.positions[3 * from + corner]);
  const auto a = result.model.face_logits(t), b = model.face_logits(from);
  EXPECT_TRUE(std::ranges::equal(a, b)) << t << " from " << from;
}

void expect_same_kind(const Model& a, const Model& b) {
  EXPECT_EQ(a.min_level, b.min_level);
  EXPECT_EQ(a.max_level, b.max_level);
  EXPECT_EQ(a.mlp, b.mlp);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.logits.size(), a.faces() * b.texels() * channels);
}

TEST(Prune, KeepsThoseOfMostPixelsInTheirOrder) {
  const Model model = random_model(41, {.faces = 6});
  const std::vector<std::uint64_t> pixels = {5, 0, 9, 5, 5, 1};
  const Resampled result = prune(model, pixels, 3);
  ASSERT_THAT(result.origin, ElementsAre(0, 2, 3));  // the first two of three fives
  EXPECT_THAT(result.is_new, Each(0));
  expect_same_kind(result.model, model);
  for (std::size_t t = 0; t < 3; ++t) expect_same_face(result, t, model, result.origin[t]);
}

TEST(Prune, MeetsTheBudgetExactly) {
  const Model model = random_model(42, {.faces = 100, .max_level = 0});
  test::Random random(42);
  std::vector<std::uint64_t> pixels(100);
  for (auto& count : pixels) count = random.below(4);  // many are equal
  for (std::size_t budget = 0; budget <= 100; ++budget) {
    const Resampled result = prune(model, pixels, budget);
    ASSERT_EQ(result.model.faces(), budget);
    ASSERT_TRUE(std::ranges::is_sorted(result.origin));
    // The simple method: a stable sort by pixels, then the first faces.
    std::vector<std::uint32_t> order(100);
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, std::greater{}, [&](std::uint32_t i) { return pixels[i]; });
    order.resize(budget);
    std::ranges::sort(order);
    ASSERT_EQ(result.origin, order);
  }
  EXPECT_EQ(prune(model, pixels, 1000).model.faces(), 100u);
}

TEST(Prune, OfUnseenFacesLeavesTheSeen) {
  const Model model = random_model(43, {.faces = 4});
  const Resampled result = prune_unseen(model, std::vector<std::uint64_t>{0, 3, 0, 1});
  ASSERT_THAT(result.origin, ElementsAre(1, 3));
  for (std::size_t t = 0; t < 2; ++t) expect_same_face(result, t, model, result.origin[t]);
}

TEST(Split, CutsGeometryAndKeepsOrientation) {
  const Model model = random_model(44, {.faces = 3, .max_level = 0});
  for (int edge = 0; edge < 3; ++edge) {
    const Split cut{.face = 1, .edge = edge, .t = 0.3f};
    const Resampled result = split(model, std::span(&cut, 1), ChildTexture::copied);
    expect_same_kind(result.model, model);
    ASSERT_THAT(result.origin, ElementsAre(0, 1, 2, 1));
    ASSERT_THAT(result.is_new, ElementsAre(0, 1, 0, 1));
    expect_same_face(result, 0, model, 0);
    expect_same_face(result, 2, model, 2);
    const int to = (edge + 1) % 3, third = (edge + 2) % 3;
    const glm::vec3* parent = &model.positions[3];
    const glm::vec3* first = &result.model.positions[3];
    const glm::vec3* second = &result.model.positions[9];
    const glm::vec3 point = first[to];
    EXPECT_EQ(second[edge], point);
    EXPECT_EQ(first[edge], parent[edge]);
    EXPECT_EQ(second[to], parent[to]);
    EXPECT_EQ(first[third], parent[third]);
    EXPECT_EQ(second[third], parent[third]);
    const glm::dvec3 expected =
        glm::dvec3(parent[edge]) + double(0.3f) * glm::dvec3(parent[to] - parent[edge]);
    // Coordinates below 4: the difference and the point are rounded to float.
    EXPECT_LT(glm::distance(glm::dvec3(point), expected), 1e-6);
    const auto normal = [](const glm::vec3* corner) {
      return glm::cross(glm::dvec3(corner[1] - corner[0]), glm::dvec3(corner[2] - corner[0]));
    };
    const glm::dvec3 whole = normal(parent);
    // Areas are 0.3 and 0.7 of the parent's, in its plane, with the same orientation.
    EXPECT_LT(glm::distance(normal(first), double(0.3f) * whole), 1e-5);
    EXPECT_LT(glm::distance(normal(second), double(1 - 0.3f) * whole), 1e-5);
  }
}

TEST(Split, CopiesTexelsVerbatim) {
  const Model model = random_model(45, {.faces = 3, .min_level = 1, .max_level = 3});
  const std::vector<Split> cuts = {{2, 0, 0.5f}, {0, 1, 0.25f}, {3, 2, 0.5f}};  // 3: a child of 2
  const Resampled result = split(model, cuts, ChildTexture::copied);
  ASSERT_THAT(result.origin, ElementsAre(0, 1, 2, 2, 0, 2));
  for (std::size_t t = 0; t < result.model.faces(); ++t)
    EXPECT_TRUE(
        std::ranges::equal(result.model.face_logits(t), model.face_logits(result.origin[t])));
}

/// Barycentrics on the model's face `origin` of a point on the result's face t: least squares in
/// double, from float positions.
glm::dvec3 on_parent(const Resampled& result, std::size_t t, glm::dvec3 b, const Model& model) {
  const glm::vec3* child = &result.model.positions[3 * t];
  const glm::vec3* parent = &model.positions[3 * std::size_t(result.origin[t])];
  const glm::dvec3 point =
      b[0] * glm::dvec3(child[0]) + b[1] * glm::dvec3(child[1]) + b[2] * glm::dvec3(child[2]);
  const glm::dvec3 u = glm::dvec3(parent[0]) - glm::dvec3(parent[2]);
  const glm::dvec3 v = glm::dvec3(parent[1]) - glm::dvec3(parent[2]);
  const glm::dvec3 p = point - glm::dvec3(parent[2]);
  const double uu = glm::dot(u, u), vv = glm::dot(v, v), uv = glm::dot(u, v);
  const double pu = glm::dot(p, u), pv = glm::dot(p, v), area = uu * vv - uv * uv;
  const double b0 = (pu * vv - pv * uv) / area, b1 = (pv * uu - pu * uv) / area;
  return {b0, b1, 1 - b0 - b1};
}

/// A model with large faces far from degenerate, so that on_parent has errors of 1e-6.
Model sturdy_model(std::uint64_t seed, const test::ModelOptions& options) {
  Model model = random_model(seed, options);
  for (std::size_t face = 0; face < model.faces(); ++face) {
    model.positions[3 * face] += glm::vec3(8, 0, 0);
    model.positions[3 * face + 1] += glm::vec3(0, 8, 0);
    model.positions[3 * face + 2] += glm::vec3(0, 0, 8);
  }
  return model;
}

/// Some cuts, at halves and elsewhere, of faces and of their children.
std::vector<Split> some_cuts(std::uint64_t seed, std::size_t faces) {
  test::Random random(seed);
  std::vector<Split> cuts;
  for (std::uint32_t i = 0; i < 12; ++i)
    cuts.push_back({random.below(std::uint32_t(faces) + i), int(random.below(3)),
                    i % 2 ? 0.5f : float(random.uniform(0.2, 0.8))});
  return cuts;
}

TEST(Split, ResampledChildrenShowAtEveryTexelWhatTheParentShowed) {
  for (const test::ModelOptions& kind :
       {test::ModelOptions{.faces = 4, .min_level = 0, .max_level = 0},
        {.faces = 4, .min_level = 2, .max_level = 3},
        {.faces = 4, .min_level = 0, .max_level = 4}}) {
    const std::uint64_t seed = 46 + kind.max_level;
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Model model = sturdy_model(seed, kind);
    const int level = kind.max_level;
    const Resampled result = split(model, some_cuts(seed, 4), ChildTexture::resampled);
    ASSERT_EQ(result.model.faces(), 16u);
    EXPECT_GE(std::ranges::count(result.is_new, 1), 13);  // 12 cuts make at least 13 new faces
    const double step = 1.0 / lattice::resolution(level);
    std::vector<float> child, parent;
    for (std::size_t t = 0; t < result.model.faces(); ++t) {
      if (!result.is_new[t]) {
        expect_same_face(result, t, model, result.origin[t]);
        continue;
      }
      fine_texture(result.model, t, child);
      fine_texture(model, result.origin[t], parent);
      for (std::uint32_t texel = 0; texel < lattice::texel_count(level); ++texel) {
        const auto [x, y] = lattice::texel_coordinates(texel);
        const glm::dvec3 b = on_parent(result, t, {x * step, y * step, 1 - (x + y) * step}, model);
        for (int c = 0; c < channels; ++c)
          // Positions are floats of up to 12, rounded at every cut: 1e-6 of an edge. Neighbouring
          // texels differ by at most 1, and there are 2^level of them along an edge.
          ASSERT_NEAR(child[std::size_t(texel) * channels + c],
                      test::textured(parent, level, b[0], b[1], c), 2e-6 * (1 << level) + 1e-6)
              << "level " << level << ", face " << t << ", texel " << texel;
      }
    }
  }
}

// An affine function on a face is the same function on its parts, for any cut.
TEST(Split, ResamplingKeepsAffineFunctionsEverywhere) {
  Model model = sturdy_model(50, {.faces = 1, .min_level = 0, .max_level = 0});
  for (int c = 0; c < channels; ++c)  // affine after the sigmoid: 0.2 .. 0.8
    for (int texel = 0; texel < 3; ++texel) {
      const double value = 0.2 + 0.6 * ((texel * 3 + c * 2) % 7) / 6.0;
      model.logits[texel * channels + c] = float(std::log(value / (1 - value)));
    }
  const Resampled result = split(model, some_cuts(50, 1), ChildTexture::resampled);
  test::Random random(51);
  std::vector<float> child, parent;
  fine_texture(model, 0, parent);
  for (std::size_t t = 0; t < result.model.faces(); ++t) {
    fine_texture(result.model, t, child);
    for (int i = 0; i < 50; ++i) {
      double b0 = random.uniform(), b1 = random.uniform();
      if (b0 + b1 > 1) b0 = 1 - b0, b1 = 1 - b1;
      const glm::dvec3 b = on_parent(result, t, {b0, b1, 1 - b0 - b1}, model);
      for (int c = 0; c < channels; ++c)
        ASSERT_NEAR(test::textured(child, 0, b0, b1, c), test::textured(parent, 0, b[0], b[1], c),
                    3e-6);  // rounding of positions, see above
    }
  }
}

/// The mean absolute difference between children cut once at one half and their parent, at random
/// points.
double mean_error(const Model& model, ChildTexture texture) {
  std::vector<Split> cuts;
  for (std::uint32_t face = 0; face < model.faces(); ++face)
    cuts.push_back({face, int(face % 3), 0.5f});
  const Resampled result = split(model, cuts, texture);
  test::Random random(52);
  std::vector<float> child, parent;
  double sum = 0;
  int count = 0;
  for (std::size_t t = 0; t < result.model.faces(); ++t) {
    fine_texture(result.model, t, child);
    fine_texture(model, result.origin[t], parent);
    for (int i = 0; i < 100; ++i, ++count) {
      double b0 = random.uniform(), b1 = random.uniform();
      if (b0 + b1 > 1) b0 = 1 - b0, b1 = 1 - b1;
      const glm::dvec3 b = on_parent(result, t, {b0, b1, 1 - b0 - b1}, model);
      sum += std::abs(test::textured(child, model.max_level, b0, b1, 0) -
                      test::textured(parent, model.max_level, b[0], b[1], 0));
    }
  }
  return sum / count;
}

// Between texels, the children have other cells, so a function has an error of second order: a
// quarter with each level.
TEST(Split, ResamplingConvergesWithTheLevel) {
  double last = 0;
  for (int level = 3; level <= 6; ++level) {
    Model model = sturdy_model(53, {.faces = 12, .min_level = level, .max_level = level});
    const double step = 1.0 / lattice::resolution(level);
    for (std::size_t face = 0; face < model.faces(); ++face)
      for (std::uint32_t texel = 0; texel < lattice::texel_count(level); ++texel) {
        const auto [x, y] = lattice::texel_coordinates(texel);
        for (int c = 0; c < channels; ++c)  // smooth, with curvature everywhere
          model.face_logits(face)[std::size_t(texel) * channels + c] =
              float(2 * std::sin(5 * x * step + double(face)) * std::cos(4 * y * step));
      }
    const double error = mean_error(model, ChildTexture::resampled);
    if (level > 3) {
      EXPECT_LT(error, 0.3 * last) << level;  // 1/4 in the limit
      EXPECT_GT(error, 0.2 * last) << level;
    }
    last = error;
    // The copied texture is a different image: at every level the error is of the image's
    // magnitude.
    EXPECT_GT(mean_error(model, ChildTexture::copied), 0.1) << level;
  }
}

TEST(Split, ResamplingSurvivesSaturatedLogits) {
  Model model = sturdy_model(54, {.faces = 1, .min_level = 0, .max_level = 1});
  for (std::size_t i = 0; i < model.logits.size(); ++i)
    model.logits[i] = (i / channels + i) % 2 ? 60.0f : -1000.0f;
  const Resampled result = split(model, some_cuts(55, 1), ChildTexture::resampled);
  EXPECT_TRUE(std::ranges::all_of(result.model.logits, [](float x) { return std::isfinite(x); }));
}

/// The sum of distances from each face's centre to the next one's.
double length_of_tour(const Model& model) {
  const auto center = [&](std::size_t face) {
    const glm::vec3* p = &model.positions[3 * face];
    return (glm::dvec3(p[0]) + glm::dvec3(p[1]) + glm::dvec3(p[2])) / 3.0;
  };
  double length = 0;
  for (std::size_t face = 1; face < model.faces(); ++face)
    length += glm::distance(center(face - 1), center(face));
  return length;
}

TEST(SpaceOrder, KeepsFacesAndPutsNeighboursTogether) {
  const Model model = random_model(71, {.faces = 4000, .max_level = 0});
  const Resampled ordered = in_space_order(model);
  ASSERT_EQ(ordered.model.faces(), model.faces());
  EXPECT_THAT(ordered.is_new, Each(0));
  std::vector<std::uint32_t> origins = ordered.origin;
  std::sort(origins.begin(), origins.end());
  for (std::uint32_t i = 0; i < origins.size(); ++i) ASSERT_EQ(origins[i], i);
  for (std::size_t t = 0; t < 50; ++t) expect_same_face(ordered, t, model, ordered.origin[t]);
  // A Morton curve through n random points has a length of O(n^(2/3)), a random order of O(n): here
  // about a fifth. A third would still be a curve, a half hardly.
  EXPECT_LT(length_of_tour(ordered.model), length_of_tour(model) / 3);
}

TEST(SpaceOrder, CanLeaveTheFirstFacesInPlace) {
  const Model model = random_model(73, {.faces = 100, .max_level = 0});
  const std::vector<std::uint32_t> origin = in_space_order(model, 40).origin;
  for (std::uint32_t i = 0; i < 40; ++i) EXPECT_EQ(origin[i], i);
  EXPECT_FALSE(std::is_sorted(origin.begin() + 40, origin.end()));
}

TEST(SpaceOrder, SurvivesPositionsThatAreNotFinite) {
  Model model = random_model(72, {.faces = 10, .max_level = 0});
  model.positions[4].y = std::numeric_limits<float>::infinity();
  model.positions[9].x = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(in_space_order(model).model.faces(), 10u);
}

}  // namespace topology_test
}  // namespace tureen::trainer
