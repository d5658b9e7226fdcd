// Views for measurements: tests of their positions on random soups.
#include "camera/camera_sets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <random>

#include "base/error.hpp"
#include "oracle/hits.hpp"
#include "scene/scene.hpp"

namespace tureen {
namespace camera_sets_test {

constexpr glm::dvec3 origin(1000, -50, 7);
const Lens lens{.width = 160, .height = 90};

/// Triangles in a ball that is flat in z: an eye in its plane sees them edge-on.
TriangleSoup flat_ball(unsigned seed, int count) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  TriangleSoup soup;
  for (int t = 0; t < count; ++t) {
    const glm::vec3 center(normal(random), normal(random), 0.2f * normal(random));
    for (int k = 0; k < 3; ++k)
      soup.positions.push_back(
          center + 0.2f * glm::vec3(normal(random), normal(random), 0.05f * normal(random)));
    const auto first = std::uint32_t(3 * t);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  soup.appearance = FaceColors{std::vector<glm::vec4>(std::size_t(count), glm::vec4(1))};
  return soup;
}

Subject subject_of_soup(const TriangleSoup& soup) {
  const Bounds box = bounds(soup);
  return {origin + glm::dvec3(box.low), origin + glm::dvec3(box.high), {0, 0, 1}};
}

glm::dvec3 towards_eye(const Subject& subject, const Camera& camera) {
  return glm::normalize(camera.eye() - subject.center());
}

/// Fragments a pixel by the oracle: every face on every pixel's ray.
double true_overdraw(const TriangleSoup& soup, const Camera& camera) {
  std::size_t count = 0;
  oracle::Rays(soup, at_origin(origin), camera)
      .visit_faces(0, camera.height, [&](int, int, const oracle::Hit&) { ++count; });
  return double(count) / (camera.width * camera.height);
}

TEST(Hemisphere, IsEvenAboveTheHorizonAndShowsTheWholeBox) {
  const TriangleSoup soup = flat_ball(1, 100);
  const Subject subject = subject_of_soup(soup);
  constexpr int count = 50;
  const std::vector<Camera> cameras = hemisphere(subject, count, lens);
  ASSERT_EQ(cameras.size(), std::size_t(count));
  EXPECT_EQ(cameras[7].name, "hemisphere 7");
  glm::dvec3 mean(0);
  double nearest = 10;
  for (const Camera& camera : cameras) {
    const glm::dvec3 direction = towards_eye(subject, camera);
    EXPECT_GT(direction.z, 0);
    mean += direction / double(count);
    for (const Camera& other : cameras)
      if (&other != &camera)
        nearest = std::min(nearest, glm::distance(direction, towards_eye(subject, other)));
    EXPECT_NEAR(glm::distance(camera.eye(), subject.center()),
                glm::distance(cameras[0].eye(), subject.center()), 1e-9);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 p(corner & 1 ? subject.low.x : subject.high.x,
                         corner & 2 ? subject.low.y : subject.high.y,
                         corner & 4 ? subject.low.z : subject.high.z);
      const glm::dvec4 clip =
          clip_from_view(camera, 1e-3, 1e3) * camera.view_from_world * glm::dvec4(p, 1.0);
      EXPECT_LE(std::max(std::abs(clip.x), std::abs(clip.y)), clip.w);
    }
  }
  // The mean direction of a half sphere is half its radius up; the tolerance is for 50 even points.
  EXPECT_NEAR(glm::length(mean - glm::dvec3(0, 0, 0.5)), 0, 0.03);
  // Equal shares of 2 pi / 50 are discs with a radius of about 0.2: no two points are closer than
  // half of that.
  EXPECT_GT(nearest, 0.15);
}

TEST(EstimatedOverdraw, ComesNearWhatTheOracleCounts) {
  for (const unsigned seed : {2u, 3u, 4u}) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const TriangleSoup soup = flat_ball(seed, 300);
    // With this number of pixels, the oracle's count of small triangles is exact to a few percent.
    const Lens fine{.width = 960, .height = 540};
    for (const Camera& camera : hemisphere(subject_of_soup(soup), 4, fine)) {
      const double exact = true_overdraw(soup, camera);
      // The estimate tests only the centre of a cell, which is coarse for triangles of about that
      // size.
      EXPECT_NEAR(estimated_overdraw(soup, origin, camera), exact, 0.1 * exact);
    }
  }
}

TEST(Facing, IsTheCosineOfOneTriangle) {
  TriangleSoup soup;
  soup.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 2, 0}};  // centroid at the origin
  soup.triangles = {{0, 1, 2}};
  soup.appearance = FaceColors{{glm::vec4(1)}};
  const auto from = [&](glm::dvec3 eye) {
    return facing(soup, origin, look_at(origin + eye, origin, {0, 1, 0}, 0.7, 64, 64));
  };
  EXPECT_NEAR(from({0, 0, 5}), 1, 1e-12);
  EXPECT_NEAR(from({5, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(from({3, 0, 3}), std::sqrt(0.5), 1e-12);
}

class Adversarial : public testing::TestWithParam<unsigned> {
 protected:
  const TriangleSoup soup = flat_ball(GetParam(), 400);
  const Subject subject = subject_of_soup(soup);
  const std::vector<Camera> views = adversarial_views(soup, origin, subject, lens);
};

TEST_P(Adversarial, AreFourOfTheLensAndAlwaysTheSame) {
  ASSERT_EQ(views.size(), 4u);
  const char* names[] = {"inside", "far", "grazing", "most overdraw"};
  const std::vector<Camera> again = adversarial_views(soup, origin, subject, lens);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(views[i].name, names[i]);
    EXPECT_EQ(views[i].width, lens.width);
    EXPECT_EQ(views[i].height, lens.height);
    EXPECT_EQ(views[i].view_from_world, again[i].view_from_world);
  }
}

TEST_P(Adversarial, InsideHasGeometryOnAllSides) {
  const glm::dvec3 eye = views[0].eye();
  int before = 0, behind = 0, left = 0, right = 0;
  for (const glm::vec3& p : soup.positions) {
    const glm::dvec4 view = views[0].view_from_world * glm::dvec4(origin + glm::dvec3(p), 1.0);
    before += view.z < 0;
    behind += view.z > 0;
    left += view.x < 0;
    right += view.x > 0;
  }
  const int quarter = int(soup.positions.size()) / 4;
  EXPECT_GT(before, quarter);
  EXPECT_GT(behind, quarter);
  EXPECT_GT(left, quarter);
  EXPECT_GT(right, quarter);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GT(eye[axis], subject.low[axis]);
    EXPECT_LT(eye[axis], subject.high[axis]);
  }
}

TEST_P(Adversarial, FarShowsTheBoxInATwentiethOfTheImage) {
  glm::dvec2 low(1e9), high(-1e9);
  for (const glm::vec3& p : soup.positions) {
    const glm::dvec4 clip = clip_from_view(views[1], 1e-3, 1e6) * views[1].view_from_world *
                            glm::dvec4(origin + glm::dvec3(p), 1.0);
    ASSERT_GT(clip.w, 0);
    low = glm::min(low, glm::dvec2(clip) / clip.w);
    high = glm::max(high, glm::dvec2(clip) / clip.w);
  }
  // Fraction of the image: a twentieth of a framed box, which fills the image wholly or partly.
  EXPECT_LT(std::max(high.x - low.x, high.y - low.y) / 2, 0.06);
  EXPECT_GT(std::max(high.x - low.x, high.y - low.y) / 2, 0.02);
}

TEST_P(Adversarial, GrazingSeesFacesEdgeOnAsNoOrdinaryViewDoes) {
  const double grazing = facing(soup, origin, views[2]);
  for (const Camera& camera : hemisphere(subject, 40, lens))
    EXPECT_LE(grazing,
              facing(soup, origin, camera) + 0.02);  // the candidates are only some directions
  // These faces are flat in z.
  EXPECT_LT(std::abs(towards_eye(subject, views[2]).z), 0.15);
}

TEST_P(Adversarial, MostOverdrawIsMoreThanAnyViewFromAboveOrAround) {
  const double most = true_overdraw(soup, views[3]);
  for (const Camera& camera : hemisphere(subject, 12, lens))
    EXPECT_GE(most, true_overdraw(soup, camera));
  for (const Camera& camera : orbit(subject, 8, {0, orbit_elevation}, lens))
    EXPECT_GE(most, true_overdraw(soup, camera));
}

INSTANTIATE_TEST_SUITE_P(Seeds, Adversarial, testing::Values(11u, 12u, 13u));

TEST(AdversarialViews, ASoupWithoutFacesHasViewsToo) {
  TriangleSoup soup;
  soup.appearance = FaceColors{};
  EXPECT_EQ(adversarial_views(soup, origin, {}, lens).size(), 4u);
}

TEST(CameraSetName, IsAKindAndANumberOfViews) {
  const auto parsed = [](const std::string& text) {
    return parse_camera_set(text, {"hemisphere", "orbit"});
  };
  EXPECT_EQ(parsed("orbit:12")->text(), "orbit:12");
  EXPECT_EQ(parsed("hemisphere")->text(), "hemisphere:8");
  for (const char* other : {"orbits:3", "orbi", "adversarial", "", ":8"})
    EXPECT_FALSE(parsed(other));
  for (const char* wrong : {"orbit:", "orbit:0", "orbit:1001", "orbit:-3", "orbit:3x", "orbit:3:4",
                            "orbit: 3", "orbit:99999999999999999999"})
    EXPECT_THROW(parsed(wrong), UsageError) << wrong;
}

}  // namespace camera_sets_test
}  // namespace tureen
