// The oracle's rays against cases computed by hand, and against a second, independent intersection
// with a triangle. Names in brackets are rows of the catalogue of numerical hazards.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <set>

#include "oracle/hits.hpp"
#include "tests/support/hits_of_pixels.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen {
namespace oracle_geometry_test {

using oracle::Attributes;
using oracle::Coverage;
using oracle::Hit;
using oracle::Rays;

constexpr Coverage both_coverages[] = {Coverage::exact, Coverage::snapped};

/// A camera at the origin that looks along -z. On the plane z = -1, one pixel is 1/64 wide.
/// at_pixel(x, y) is exactly (x, y) pixels from the top left corner, for the integers and halves
/// used here.
Camera straight_camera(int width = 64, int height = 64) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = 64;
  camera.cx = 0.5 * width;
  camera.cy = 0.5 * height;
  return camera;
}

glm::vec3 at_pixel(const Camera& camera, double x, double y) {
  return glm::vec3((x - camera.cx) / 64, (camera.cy - y) / 64, -1);
}

TriangleSoup soup_of(std::vector<glm::vec3> positions) {
  TriangleSoup soup;
  soup.positions = std::move(positions);
  for (std::uint32_t v = 0; v + 2 < soup.positions.size(); v += 3)
    soup.triangles.emplace_back(v, v + 1, v + 2);
  soup.appearance = FaceColors{std::vector<glm::vec4>(soup.triangles.size(), glm::vec4(1))};
  return soup;
}

std::vector<int> hit_counts(const TriangleSoup& soup, const Camera& camera, Coverage coverage) {
  std::vector<int> counts(std::size_t(camera.width) * camera.height);
  const Rays rays(soup, glm::dmat4(1.0), camera, {.coverage = coverage});
  rays.visit_faces(0, camera.height, [&](int column, int row, const Hit& hit) {
    EXPECT_TRUE(std::isfinite(hit.b0) && std::isfinite(hit.b1) && std::isfinite(hit.depth));
    ++counts[std::size_t(row) * camera.width + column];
  });
  return counts;
}

TEST(OracleRays, OneTriangleCoversExactlyThePixelsWhoseCentersLieInIt) {
  const Camera camera = straight_camera(8, 8);
  // The legs are on the lines x = 1 and y = 1. The hypotenuse x + y = 7 runs through pixel centres,
  // but it faces right and down, so the face owns none of them. Both windings.
  for (const bool swapped : {false, true})
    for (const Coverage coverage : both_coverages) {
      std::vector<glm::vec3> corners = {at_pixel(camera, 1, 1), at_pixel(camera, 6, 1),
                                        at_pixel(camera, 1, 6)};
      if (swapped) std::swap(corners[1], corners[2]);
      const auto counts = hit_counts(soup_of(corners), camera, coverage);
      for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 8; ++column)
          EXPECT_EQ(counts[row * 8 + column], column >= 1 && row >= 1 && column + row < 6)
              << column << ", " << row;
    }
}

/// 1 if pixel centres on a horizontal edge belong to the face above it.
int owner_shift(Coverage coverage) {
  return coverage == Coverage::snapped && !oracle::snapped_upper_edge_owns ? 1 : 0;
}

TEST(OracleRays, ACenterOnAnEdgeBelongsToTheRightAndToOneOfUpperAndLower) {
  const Camera camera = straight_camera(8, 8);
  // The square between the centres of pixels (2, 2) and (5, 5).
  const glm::vec3 a = at_pixel(camera, 2.5, 2.5), b = at_pixel(camera, 5.5, 2.5),
                  c = at_pixel(camera, 5.5, 5.5), d = at_pixel(camera, 2.5, 5.5);
  for (const Coverage coverage : both_coverages) {
    const int shift = owner_shift(coverage);
    const auto counts = hit_counts(soup_of({a, b, c, a, c, d}), camera, coverage);
    for (int row = 0; row < 8; ++row)
      for (int column = 0; column < 8; ++column)
        EXPECT_EQ(counts[row * 8 + column],
                  column >= 2 && column < 5 && row >= 2 + shift && row < 5 + shift)
            << column << ", " << row;
  }
}

TEST(OracleRays, SnapsToTheGridOfTheDevice) {
  const Camera camera = straight_camera(8, 8);
  // The left edge is 3/64 of a pixel right of the centres of column 2. A grid of 1/16 pixel rounds
  // it to 1/16. A grid of 1/8 rounds it to the centres, which the face then owns.
  const double left = 2.5 + 3.0 / 64;
  const TriangleSoup soup =
      soup_of({at_pixel(camera, left, 1), at_pixel(camera, left, 7), at_pixel(camera, 14, 7)});
  const auto covers_column_2 = [&](int bits) {
    bool covered = false;
    const Rays rays(soup, glm::dmat4(1.0), camera,
                    {.coverage = Coverage::snapped, .subpixel_bits = bits});
    rays.visit_faces(0, 8, [&](int column, int, const Hit&) { covered = covered || column == 2; });
    return covered;
  };
  EXPECT_TRUE(covers_column_2(3));
  EXPECT_FALSE(covers_column_2(4));
  EXPECT_FALSE(covers_column_2(8));
  EXPECT_FALSE(covers_column_2(16));
}

TEST(OracleRays, BarycentricsAndDepthArePerspectiveCorrect) {
  const Camera camera = straight_camera();
  // Vertices are at depths 1, 2 and 4. The test recomputes the hit from its barycentrics.
  const TriangleSoup soup = soup_of({{-0.4f, -0.3f, -1}, {0.9f, -0.5f, -2}, {0.3f, 1.7f, -4}});
  for (const Attributes attributes : {Attributes::unsnapped, Attributes::snapped}) {
    const Rays rays(soup, glm::dmat4(1.0), camera,
                    {.coverage = Coverage::snapped, .attributes = attributes});
    int hits = 0;
    rays.visit_faces(0, 64, [&](int column, int row, const Hit& hit) {
      const glm::dvec3 p = hit.b0 * glm::dvec3(soup.positions[0]) +
                           hit.b1 * glm::dvec3(soup.positions[1]) +
                           (1 - hit.b0 - hit.b1) * glm::dvec3(soup.positions[2]);
      // Snapped corners are off by up to 1/512 pixel, and so are interpolated values.
      const double tolerance = attributes == Attributes::snapped ? 1.0 / 256 : 1e-9;
      EXPECT_NEAR(camera.cx + 64 * p.x / -p.z, column + 0.5, tolerance);
      EXPECT_NEAR(camera.cy - 64 * p.y / -p.z, row + 0.5, tolerance);
      EXPECT_NEAR(-p.z, hit.depth, 20 * tolerance / 64);
      ++hits;
    });
    EXPECT_GT(hits, 500);
  }
}

// The independent reference: Moeller and Trumbore, Fast, minimum storage ray/triangle intersection
// (1997). It works in world space, without an image plane.
std::optional<Hit> moeller_trumbore(const TriangleSoup& soup, std::uint32_t face, glm::dvec3 eye,
                                    glm::dvec3 direction, double margin) {
  const glm::uvec3 t = soup.triangles[face];
  const glm::dvec3 v2(soup.positions[t[2]]);
  const glm::dvec3 e0 = glm::dvec3(soup.positions[t[0]]) - v2;
  const glm::dvec3 e1 = glm::dvec3(soup.positions[t[1]]) - v2;
  const glm::dvec3 p = glm::cross(direction, e1);
  const double determinant = glm::dot(e0, p);
  const glm::dvec3 s = eye - v2;
  const glm::dvec3 q = glm::cross(s, e0);
  const Hit hit{face, glm::dot(s, p) / determinant, glm::dot(direction, q) / determinant,
                glm::dot(e1, q) / determinant};
  const bool inside = hit.b0 >= margin && hit.b1 >= margin && 1 - hit.b0 - hit.b1 >= margin;
  return inside && std::isfinite(hit.depth) ? std::optional(hit) : std::nullopt;
}

/// Every hit by the oracle is a hit by the reference, and vice versa. Within 1e-9 of an edge, in
/// barycentrics, either result is correct.
void expect_brute_force_agrees(const TriangleSoup& soup, const Camera& camera) {
  const Rays rays(soup, glm::dmat4(1.0), camera);
  std::vector<std::vector<Hit>> found(std::size_t(camera.width) * camera.height);
  test::visit_pixels(rays, camera, [&](int column, int row, std::span<const Hit> hits) {
    found[std::size_t(row) * camera.width + column].assign(hits.begin(), hits.end());
  });
  const glm::dmat3 world_from_view = camera.world_from_view_rotation();
  int total = 0;
  for (int row = 0; row < camera.height; ++row)
    for (int column = 0; column < camera.width; ++column) {
      const auto& hits = found[std::size_t(row) * camera.width + column];
      total += int(hits.size());
      for (std::size_t i = 1; i < hits.size(); ++i)
        ASSERT_LE(hits[i - 1].depth, hits[i].depth) << column << ", " << row;
      const glm::dvec3 ray = world_from_view * glm::dvec3((column + 0.5 - camera.cx) / camera.fx,
                                                          (camera.cy - row - 0.5) / camera.fy, -1);
      for (std::uint32_t face = 0; face < soup.triangles.size(); ++face) {
        const auto hit =
            std::find_if(hits.begin(), hits.end(), [&](const Hit& h) { return h.face == face; });
        constexpr double slack = 1e-9;
        if (hit == hits.end()) {
          const auto missed = moeller_trumbore(soup, face, camera.eye(), ray, slack);
          if (missed) {
            ASSERT_LT(missed->depth, rays.range().near * (1 + slack))
                << "face " << face << " at " << column << ", " << row;
          }
        } else {
          const auto same = moeller_trumbore(soup, face, camera.eye(), ray, -slack);
          ASSERT_TRUE(same) << "face " << face << " at " << column << ", " << row;
          // Both lose digits on faces seen nearly edge-on.
          ASSERT_NEAR(same->b0, hit->b0, 1e-7);
          ASSERT_NEAR(same->b1, hit->b1, 1e-7);
          ASSERT_NEAR(same->depth, hit->depth, 1e-7);
        }
      }
    }
  EXPECT_GT(total, 0);
}

class OracleRaysOnSoup : public testing::TestWithParam<std::uint64_t> {};

TEST_P(OracleRaysOnSoup, AgreesWithMoellerTrumbore) {
  test::Random random(GetParam());
  const TriangleSoup soup = test::random_soup(
      GetParam(), {.faces = 60, .size = 0.3, .shared_vertices = GetParam() % 2 == 1});
  expect_brute_force_agrees(soup, test::random_camera(random, 48, 36));
}

// [G4] The eye within the soup: faces cross the eye's plane everywhere.
TEST_P(OracleRaysOnSoup, AgreesWithMoellerTrumboreFromWithin) {
  test::Random random(GetParam());
  const TriangleSoup soup = test::random_soup(GetParam() + 100, {.faces = 60, .size = 0.5});
  const Camera camera =
      look_at(0.2 * random.direction(), random.direction(), random.direction(), 1.2, 48, 36);
  expect_brute_force_agrees(soup, camera);
}

INSTANTIATE_TEST_SUITE_P(Seed, OracleRaysOnSoup, testing::Range<std::uint64_t>(1, 7),
                         testing::PrintToStringParamName());

// [G2] A strip of 1000 slivers whose edges pass through pixel centres.
TEST(OracleRays, SliversThatShareEdgesCoverEveryCenterOnce) {
  const Camera camera = straight_camera();
  std::vector<glm::vec3> corners;
  const auto top = [&](int i) { return at_pixel(camera, 2 + 60.0 * i / 500, 2.5); };
  const auto bottom = [&](int i) { return at_pixel(camera, 2 + 60.0 * i / 500, 61.5); };
  for (int i = 0; i < 500; ++i)
    for (const glm::vec3& p : {top(i), bottom(i), top(i + 1), top(i + 1), bottom(i), bottom(i + 1)})
      corners.push_back(p);
  for (const Coverage coverage : both_coverages) {
    const int shift = owner_shift(coverage);
    const auto counts = hit_counts(soup_of(corners), camera, coverage);
    for (int row = 0; row < 64; ++row)
      for (int column = 0; column < 64; ++column)
        ASSERT_EQ(counts[row * 64 + column],
                  column >= 2 && column < 62 && row >= 2 + shift && row < 61 + shift)
            << column << ", " << row;
  }
}

// [G2] Needles of aspect 10 to 10^7 that share their long edges.
TEST(OracleRays, AFanOfNeedlesCoversEveryCenterOnce) {
  const Camera camera = straight_camera();
  std::vector<glm::vec3> corners;
  double x = 3;
  for (int i = 0; i < 70; ++i) {
    const double wide = 60 * std::pow(10.0, -1 - i % 7);
    for (const glm::vec3& p :
         {at_pixel(camera, 31.5, 60), at_pixel(camera, x, 3), at_pixel(camera, x + wide, 3)})
      corners.push_back(p);
    x += wide;
  }
  for (const Coverage coverage : both_coverages) {
    const auto counts = hit_counts(soup_of(corners), camera, coverage);
    const auto whole = hit_counts(
        soup_of({at_pixel(camera, 31.5, 60), at_pixel(camera, 3, 3), at_pixel(camera, x, 3)}),
        camera, coverage);
    for (std::size_t i = 0; i < counts.size(); ++i) ASSERT_EQ(counts[i], whole[i]) << i;
  }
}

// [G4] A floor from behind the eye to the horizon.
TEST(OracleRays, AFloorThroughTheCameraIsSeenBelowTheHorizonOnly) {
  const Camera camera = straight_camera();
  const glm::vec3 a(-500, -1, 100), b(500, -1, 100), c(500, -1, -100), d(-500, -1, -100);
  const TriangleSoup soup = soup_of({a, b, c, a, c, d});
  for (const Coverage coverage : both_coverages) {
    const auto counts = hit_counts(soup, camera, coverage);
    const Rays rays(soup, glm::dmat4(1.0), camera, {.coverage = coverage});
    for (int row = 0; row < 64; ++row) {
      const double depth = 64 / (row + 0.5 - 32);
      const bool floor = depth > rays.range().near && depth < 100;
      for (int column = 0; column < 64; ++column)
        ASSERT_EQ(counts[row * 64 + column], floor) << column << ", " << row;
    }
    rays.visit_faces(0, 64, [&](int, int row, const Hit& hit) {
      ASSERT_NEAR(hit.depth, 64 / (row + 0.5 - 32), 1e-9);
    });
  }
}

// [G5] Vertices in the eye's plane, next to it, and behind it.
TEST(OracleRays, VerticesInTheEyePlaneAgreeWithTheReference) {
  const Camera camera = straight_camera(32, 24);
  std::vector<glm::vec3> corners;
  for (const float z : {0.0f, -0.0f, 1e-30f, -1e-30f, 1.0f, 1e-7f, -1e-7f})
    for (const float x : {-1.0f, 0.0f, 1e-3f}) {
      corners.insert(corners.end(), {{x, 0.2f, z}, {0.5f, -0.4f, -2}, {-0.6f, -0.3f, -1.5f}});
      corners.insert(corners.end(), {{x, 0.1f, z}, {0.5f, 0.4f, z}, {-0.6f, -0.3f, -1.5f}});
    }
  expect_brute_force_agrees(soup_of(corners), camera);
  hit_counts(soup_of(corners), camera, Coverage::snapped);
}

TEST(OracleRays, HugeAndTinyCoordinatesStayFinite) {
  const Camera camera = straight_camera(32, 24);
  for (const float scale : {1e-30f, 1e-10f, 1e10f, 1e30f, 3e38f}) {
    const TriangleSoup soup =
        soup_of({{-scale, -scale, -scale}, {scale, -scale, -scale}, {0, scale, -scale}});
    for (const Coverage coverage : both_coverages) hit_counts(soup, camera, coverage);
  }
}

// [G1]
TEST(OracleRays, FacesWithoutAreaOrWithNonFiniteVerticesHitNothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const glm::vec3 a(-0.25f, 0, -1), b(0.25f, 0, -1), c(0, 0.25f, -1);
  const TriangleSoup soup = soup_of({a,
                                     a,
                                     b,
                                     a,
                                     b,
                                     b,
                                     a,
                                     a,
                                     a,
                                     a,
                                     b,
                                     0.5f * (a + b),
                                     {nan, 0, -1},
                                     b,
                                     c,
                                     a,
                                     {0, infinity, -1},
                                     c,
                                     a,
                                     b,
                                     {0, 0.2f, -infinity}});
  for (const Coverage coverage : both_coverages)
    for (const int count : hit_counts(soup, straight_camera(), coverage)) ASSERT_EQ(count, 0);
}

TEST(OracleRays, ViewDirectionsAreUnitAndPointBackToTheEye) {
  test::Random random(3);
  const Camera camera = test::random_camera(random, 40, 30);
  const TriangleSoup soup = test::random_soup(3, {.faces = 40, .size = 0.4});
  const Rays rays(soup, glm::dmat4(1.0), camera);
  int hits = 0;
  rays.visit_faces(0, 30, [&](int column, int row, const Hit& hit) {
    const glm::uvec3 t = soup.triangles[hit.face];
    const glm::dvec3 p = hit.b0 * glm::dvec3(soup.positions[t[0]]) +
                         hit.b1 * glm::dvec3(soup.positions[t[1]]) +
                         (1 - hit.b0 - hit.b1) * glm::dvec3(soup.positions[t[2]]);
    // The tolerance is ten digits coarser than the barycentrics.
    ASSERT_NEAR(glm::distance(rays.to_eye(column, row), glm::normalize(camera.eye() - p)), 0, 1e-7);
    ++hits;
  });
  EXPECT_GT(hits, 100);
}

}  // namespace oracle_geometry_test
}  // namespace tureen
