// The parts of the example's generator whose errors would be hard to see.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <tuple>

#include "examples/glaze.hpp"
#include "examples/light.hpp"
#include "examples/noise.hpp"
#include "examples/ray_caster.hpp"
#include "examples/still_life.hpp"

namespace tureen::example {
namespace generator_test {

const Model& model() {
  static const Model made = still_life();
  return made;
}

struct SlowHit {
  double distance;
  glm::dvec2 uv;
};

/// By signed volumes: shares only the geometry with the ray caster.
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
  // Only the porcelain and the lemons: slow_hit() does not support holes.
  Model solid;
  for (const Surface& surface : model().surfaces)
    if (!surface.cut_out) solid.add(surface);
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
    EXPECT_NEAR(hit->distance, nearest, 1e-9) << "ray " << i;  // rounding in two different methods
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
                     return Paint{.hole = glm::distance(at.uv, glm::dvec2(0.5)) < 0.2};
                   },
               .columns = 2,
               .rows = 2,
               .cut_out = true});
  const RayCaster caster(pierced);
  EXPECT_FALSE(caster.first_hit({0.55, 1, 0.45}, {0, -1, 0}, 0));
  EXPECT_TRUE(caster.first_hit({0.85, 1, 0.45}, {0, -1, 0}, 0));
}

TEST(StillLife, TurnedSurfacesHaveNoCracks) {
  // Every edge inside a closed surface belongs to two faces, exactly.
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
    EXPECT_LE(open, 2 * surface.columns) << "surface " << s;  // at most two rims
    ++closed;
  }
  EXPECT_GT(closed, 8);
}

TEST(StillLife, OnlyWhatIsCutOutHasHoles) {
  int cut_out = 0;
  for (std::uint32_t s = 0; s < model().surfaces.size(); ++s) {
    int holes = 0;
    for (int i = 0; i < 10000; ++i) {
      const int column = i % 100, row = i / 100;
      const glm::dvec2 uv((column + 0.5) / 100, (row + 0.5) / 100);
      holes += model().paint(model().point(s, uv), s).hole;
    }
    EXPECT_EQ(holes > 0, model().surfaces[s].cut_out) << "surface " << s;
    EXPECT_LT(holes, 9000) << "surface " << s;
    cut_out += model().surfaces[s].cut_out;
  }
  EXPECT_GT(cut_out, 20);  // leaves, petals, lace
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

}  // namespace generator_test
}  // namespace tureen::example
