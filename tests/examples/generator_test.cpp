// The parts of the example's generator that could be wrong without looking wrong.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <tuple>

#include "glaze.hpp"
#include "light.hpp"
#include "noise.hpp"
#include "ray_caster.hpp"
#include "soup/triangle_soup.hpp"
#include "still_life.hpp"
#include "training.hpp"

namespace tureen::example {
namespace {

const Model& model() {
  static const Model made = still_life();
  return made;
}

struct SlowHit {
  double distance;
  glm::dvec2 uv;
};

/// Signed volumes: nothing shared with the ray caster but the geometry.
std::optional<SlowHit> slow_hit(const Face& face, glm::dvec3 o, glm::dvec3 d) {
  const auto &a = face.corners[0], &b = face.corners[1], &c = face.corners[2];
  const double va = glm::dot(d, glm::cross(b - o, c - o));
  const double vb = glm::dot(d, glm::cross(c - o, a - o));
  const double vc = glm::dot(d, glm::cross(a - o, b - o));
  if (!((va > 0 && vb > 0 && vc > 0) || (va < 0 && vb < 0 && vc < 0))) return std::nullopt;
  const glm::dvec3 weight = glm::dvec3(va, vb, vc) / (va + vb + vc);
  const glm::dvec3 hit = weight.x * a + weight.y * b + weight.z * c;
  return SlowHit{glm::dot(hit - o, d),
                 weight.x * face.uv[0] + weight.y * face.uv[1] + weight.z * face.uv[2]};
}

TEST(RayCaster, FindsWhatTryingEveryFaceFinds) {
  constexpr std::uint64_t seed = 4;
  SCOPED_TRACE("seed 4");
  // The porcelain and the lemons: nothing with holes, which the slow way does not know.
  Model solid;
  for (const Surface& surface : model().surfaces) {
    bool holes = false;
    for (int i = 0; i < 400 && !holes; ++i) {
      const SurfacePoint at{{(i % 20 + 0.5) / 20, (i / 20 + 0.5) / 20}, {0, 0, 0}, {0, 1, 0}};
      holes = surface.paint(at).alpha < alpha_threshold;
    }
    if (!holes) solid.add(surface);
  }
  const RayCaster caster(solid);
  Random random(seed);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const auto coordinate = [&] { return random.uniform(-2.5, 2.5); };
    const glm::dvec3 origin(coordinate(), coordinate() + 2, coordinate());
    const glm::dvec3 target(0.6 * coordinate(), random.uniform(0, 1.5), 0.6 * coordinate());
    const glm::dvec3 direction = glm::normalize(target - origin);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Face& face : solid.faces)
      if (const auto hit = slow_hit(face, origin, direction))
        if (hit->distance > 0.01) nearest = std::min(nearest, hit->distance);
    const auto found = caster.first_hit(origin, direction, 0.01);
    ASSERT_EQ(found.has_value(), std::isfinite(nearest)) << "ray " << i;
    if (!found) continue;
    ++hits;
    const auto hit = slow_hit(solid.faces[found->face], origin, direction);
    ASSERT_TRUE(hit) << "ray " << i;
    EXPECT_NEAR(hit->distance, nearest, 1e-9) << "ray " << i;  // rounding of two ways to compute it
    EXPECT_LT(glm::distance(hit->uv, found->uv), 1e-9) << "ray " << i;
  }
  EXPECT_GT(hits, 100);
}

TEST(RayCaster, HolesLetARayPass) {
  // A square with a round hole in the middle.
  Model pierced;
  pierced.add({.position = [](glm::dvec2 uv) { return glm::dvec3(uv.y, 0, uv.x); },
               .paint =
                   [](const SurfacePoint& at) {
                     return Paint{.alpha = glm::distance(at.uv, glm::dvec2(0.5)) < 0.2 ? 0.0 : 1.0};
                   },
               .columns = 2,
               .rows = 2,
               .texel_size = 0.05});
  const RayCaster caster(pierced);
  EXPECT_FALSE(caster.first_hit({0.55, 1, 0.45}, {0, -1, 0}, 0));
  EXPECT_TRUE(caster.first_hit({0.85, 1, 0.45}, {0, -1, 0}, 0));
}

TEST(StillLife, TurnedSurfacesHaveNoCracks) {
  // Every edge inside a closed surface belongs to two faces, to the last bit.
  using Point = std::tuple<float, float, float>;
  const auto point = [](const glm::dvec3& p) { return Point(p.x, p.y, p.z); };
  int closed = 0;
  for (std::uint32_t s = 0; s < model().surfaces.size(); ++s) {
    const Surface& surface = model().surfaces[s];
    if (!surface.closed) continue;
    std::map<std::pair<Point, Point>, int> edges;
    for (const Face& face : model().faces)
      if (face.surface == s)
        for (int i = 0; i < 3; ++i)
          ++edges[std::minmax(point(face.corners[i]), point(face.corners[(i + 1) % 3]))];
    int open = 0;
    for (const auto& [edge, count] : edges) {
      EXPECT_LE(count, 2) << "surface " << s;
      open += count == 1;
    }
    if (surface.paint(model().point(s, {0.5, 0.5})).alpha < 1) continue;
    // Two rims at most; the doily's faces that are cut away leave more.
    const bool doily = surface.rows == 2;
    if (!doily) {
      EXPECT_LE(open, 2 * surface.columns) << "surface " << s;
    }
    ++closed;
  }
  EXPECT_GT(closed, 8);
}

TEST(Training, LearnsAHighlight) {
  // A blob of light around one normal, on a base colour that it must leave alone elsewhere.
  const auto draw = [](Random& random) {
    Example example{};
    for (int c = 0; c < 3; ++c) example.features[c] = random.uniform(0.2, 0.6);
    example.features[3] = 0.6;
    const double a = random.uniform(0, 6.2831853);
    const glm::dvec3 n(0.6 * std::cos(a), 0.8, 0.6 * std::sin(a));
    for (int c = 0; c < 3; ++c) example.features[4 + c] = 0.5 + 0.5 * n[c];
    example.to_eye = {0, 0, 1};
    const double light = std::pow(std::max(0.0, n.z / 0.6), 8.0);
    for (int c = 0; c < 3; ++c) example.color[c] = glm::mix(example.features[c], 0.95, 0.5 * light);
    return example;
  };
  const Training untrained = train(draw, {.steps = 1, .batch = 4096});
  const Training trained = train(draw, {.steps = 3000, .batch = 64, .rate = 1e-2});
  EXPECT_FALSE(defect(trained.mlp, 7));
  EXPECT_LT(trained.root_mean_square, 0.025);
  EXPECT_GT(untrained.root_mean_square, 4 * trained.root_mean_square);

  // What evaluate() draws is what was trained.
  Random random(9);
  double squares = 0;
  for (int i = 0; i < 500; ++i) {
    const Example example = draw(random);
    const glm::dvec3 color = evaluate(trained.mlp, example.features, example.to_eye);
    squares += glm::dot(color - example.color, color - example.color) / 3;
  }
  EXPECT_NEAR(std::sqrt(squares / 500), trained.root_mean_square,
              0.3 * trained.root_mean_square);  // another sample of the same error
}

TEST(Glaze, MirrorsMoreAtGrazingAnglesAndNotWithoutGloss) {
  const glm::dvec3 diffuse(0.3), bright(1.0), none(0.0);
  const double facing = glazed(diffuse, 0.6, 1.0, bright).g,
               grazing = glazed(diffuse, 0.6, 0.1, bright).g;
  EXPECT_GT(facing, displayed(diffuse).g);
  EXPECT_GT(grazing, facing + 0.1);
  EXPECT_EQ(glazed(diffuse, 0.0, 0.1, bright), displayed(diffuse));
  EXPECT_LT(glazed(diffuse, 0.6, 1.0, none).g, displayed(diffuse).g);
}

}  // namespace
}  // namespace tureen::example
