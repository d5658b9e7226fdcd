#include "camera/navigation.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <random>

namespace tureen {
namespace navigation_test {

constexpr double pi = 3.14159265358979323846;

/// A world point in NDC: inside the image within -1..1.
glm::dvec2 ndc_of(const Camera& camera, glm::dvec3 world) {
  const glm::dvec4 clip =
      clip_from_view(camera, 1e-3, 1e3) * camera.view_from_world * glm::dvec4(world, 1.0);
  EXPECT_GT(clip.w, 0) << "behind the eye";
  return {clip.x / clip.w, clip.y / clip.w};
}

double largest_ndc(const Camera& camera, const Subject& subject) {
  double largest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p(corner & 1 ? subject.low.x : subject.high.x,
                       corner & 2 ? subject.low.y : subject.high.y,
                       corner & 4 ? subject.low.z : subject.high.z);
    const glm::dvec2 ndc = ndc_of(camera, p);
    largest = std::max({largest, std::abs(ndc.x), std::abs(ndc.y)});
  }
  return largest;
}

TEST(Navigation, FramesRandomBoxesTightlyFromEverySide) {
  const unsigned seed = 3;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return glm::dvec3(uniform(random), uniform(random), uniform(random)); };
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 center = 10.0 * vector(), half = glm::abs(vector());
    const Subject subject{center - half, center + half, vector()};
    const Lens lens{100 + int(500 * (1 + uniform(random))), 300, 0.7 + 0.5 * uniform(random)};
    const Bearing bearing{pi * uniform(random), 1.4 * uniform(random)};
    // The tightest side has a margin of exactly 5 %.
    EXPECT_NEAR(largest_ndc(frame(subject, bearing, lens), subject), 1 / 1.05, 1e-9);
  }
}

TEST(Navigation, TheFrontIsPlusZUnderYAndMinusYUnderZ) {
  EXPECT_LT(glm::length(direction_of({0, 1, 0}, {}) - glm::dvec3(0, 0, 1)), 1e-12);
  EXPECT_LT(glm::length(direction_of({0, 0, 2}, {}) - glm::dvec3(0, -1, 0)), 1e-12);
  // A quarter turn leads to the right of a viewer in front: +x in both.
  EXPECT_LT(glm::length(direction_of({0, 1, 0}, {pi / 2, 0}) - glm::dvec3(1, 0, 0)), 1e-12);
  EXPECT_LT(glm::length(direction_of({0, 0, 1}, {pi / 2, 0}) - glm::dvec3(1, 0, 0)), 1e-12);
  EXPECT_LT(glm::length(direction_of({0, 0, 1}, {0, pi / 2}) - glm::dvec3(0, 0, 1)), 1e-12);
}

/// The first view of every program, as angles in degrees: the goldens of the window have it, too.
TEST(Navigation, TheThreeQuarterViewIs35DegreesToTheRightAnd20Above) {
  const Subject subject{{-1, -1, -1}, {1, 1, 1}, {0, 1, 0}};
  const glm::dvec3 eye = frame(subject, three_quarter_view, Lens{}).eye();
  EXPECT_NEAR(glm::degrees(std::atan2(eye.x, eye.z)), 35, 1e-9);
  EXPECT_NEAR(glm::degrees(std::asin(eye.y / glm::length(eye))), 20, 1e-9);
  EXPECT_NEAR(glm::degrees(orbit_elevation), 20, 1e-9);
}

TEST(Navigation, UpIsUpInTheFramedImage) {
  for (const glm::dvec3 up : {glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0)}) {
    const Subject subject{glm::dvec3(-1), glm::dvec3(1), up};
    const Camera camera = frame(subject, three_quarter_view, Lens{});
    const glm::dvec2 above = ndc_of(camera, 0.1 * up), below = ndc_of(camera, -0.1 * up);
    EXPECT_NEAR(above.x, 0, 1e-9);
    EXPECT_GT(above.y, below.y);
  }
}

TEST(Navigation, AnOrbitKeepsItsDistanceAndShowsEverythingEverywhere) {
  const Subject subject{{-3, -1, -0.5}, {3, 1, 0.5}, {0, 0, 1}};
  const std::vector<Camera> cameras = orbit(subject, 12, {0, orbit_elevation}, Lens{});
  ASSERT_EQ(cameras.size(), 12u);
  const double distance = glm::length(cameras[0].eye() - subject.center());
  double tightest = 0;
  for (const Camera& camera : cameras) {
    EXPECT_NEAR(glm::length(camera.eye() - subject.center()), distance, 1e-9);
    EXPECT_NEAR(camera.eye().z, distance * std::sin(orbit_elevation), 1e-9);
    tightest = std::max(tightest, largest_ndc(camera, subject));
  }
  EXPECT_NEAR(tightest, 1 / 1.05, 1e-9);
  // The views are even: opposite views face each other.
  const glm::dvec3 a = cameras[2].eye(), b = cameras[8].eye();
  EXPECT_NEAR(a.x, -b.x, 1e-9);
  EXPECT_NEAR(a.y, -b.y, 1e-9);
}

TEST(Navigation, APointAndAMissingUpAxisStillGiveACamera) {
  const Camera camera = frame({{2, 2, 2}, {2, 2, 2}, {0, 0, 0}}, three_quarter_view, Lens{});
  EXPECT_TRUE(std::isfinite(glm::length(camera.eye())));
  EXPECT_NEAR(glm::determinant(glm::dmat3(camera.view_from_world)), 1, 1e-12);
}

TEST(Navigation, TheSubjectOfASceneIsItsBoundsInTheWorld) {
  TriangleSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 3}, {9, 9, 9}};  // no face uses the last one
  soup.triangles = {{0, 1, 2}};
  soup.appearance = FaceColors{{glm::vec4(1)}};
  Scene scene = scene_of(soup, {100, 200, 300});
  scene.info.up = {0, 0, 1};
  const Subject subject = subject_of(scene);
  EXPECT_EQ(subject.low, glm::dvec3(100, 200, 300));
  EXPECT_EQ(subject.high, glm::dvec3(101, 202, 303));
  EXPECT_EQ(subject.up, glm::dvec3(0, 0, 1));
  only_layer(scene).primitives =
      Splats{.kernel = TriangleWindows{
                 .corners = {{0, 0, 0}, {1, 0, 0}, {0, 2, 3}}, .sigma = {1}, .opacity = {1}}};
  EXPECT_EQ(subject_of(scene).high, glm::dvec3(101, 202, 303));
}

TEST(Navigation, TheSubjectOmitsStraySplats) {
  Gaussians gaussians;
  for (int i = 0; i < 200; ++i)
    gaussians.centers.emplace_back(i % 5 / 4.0f, i / 5 % 5 / 4.0f, i / 25 / 7.0f);
  gaussians.centers[17].x = 1000;
  gaussians.scales.assign(200, glm::vec3(0.01f));
  gaussians.rotations.assign(200, glm::quat(1, 0, 0, 0));
  gaussians.opacity.assign(200, 1.0f);
  Scene scene;
  scene.layers.push_back({.primitives = Splats{.kernel = std::move(gaussians)}});
  const Subject subject = subject_of(scene);
  EXPECT_NEAR(subject.high.x, 1, 0.1);
  EXPECT_NEAR(subject.high.y, 1, 0.1);
}

TEST(Navigation, TheSubjectEndsAroundWhatTheCamerasInsideLookAt) {
  const LayerPlace around{{{-20, -20, -20}, {20, 20, 0.5}}, glm::dmat4(1.0)};
  const LayerPlace beside{{{30, 30, 0}, {31, 31, 0.2}}, glm::dmat4(1.0)};
  const auto ring = [](double distance) {
    std::vector<Camera> cameras;
    for (int i = 0; i < 12; ++i)
      cameras.push_back(look_at({distance * std::cos(i * 0.5), distance * std::sin(i * 0.5), -1},
                                {1, 2, 0}, {0, 0, 1}, 0.8, 80, 60));
    return cameras;
  };
  const auto subject = [](std::vector<LayerPlace> boxes, const std::vector<Camera>& cameras) {
    return subject_of(boxes, {0, 0, 1}, cameras);
  };
  const Subject near = subject({around}, ring(8));
  EXPECT_NEAR(near.center().x, 1, 1e-6);
  EXPECT_NEAR(near.center().y, 2, 1e-6);
  EXPECT_GT(near.high.x, 2);
  EXPECT_LT(near.high.x, 6);
  EXPECT_EQ(near.high.z, 0.5);  // not larger than the box
  EXPECT_EQ(near.up, glm::dvec3(0, 0, 1));
  // A box without the cameras is whole.
  EXPECT_EQ(subject({around, beside}, ring(8)).high.x, 31);
  EXPECT_EQ(subject({around}, ring(50)).low, glm::dvec3(-20));
  EXPECT_EQ(subject({around}, {}).low, glm::dvec3(-20));
  // Cameras that look outwards: the box around them, of twice their extent.
  std::vector<Camera> outwards = ring(4);
  for (Camera& camera : outwards)
    camera = look_at(camera.eye(), 2.0 * camera.eye(), {0, 0, 1}, 0.8, 80, 60);
  EXPECT_NEAR(subject({around}, outwards).high.x, 8, 1);
}

TEST(Navigation, TheSubjectOfSeveralLayersContainsAll) {
  TriangleSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 3}};
  soup.triangles = {{0, 1, 2}};
  soup.appearance = FaceColors{{glm::vec4(1)}};
  Scene scene = scene_of(soup, {100, 200, 300});
  Layer second{.visible = false, .primitives = soup};
  // Twice as large, turned by 90 degrees about z: x becomes y, and y becomes -x.
  second.world_from_layer = {{0, 2, 0, 0}, {-2, 0, 0, 0}, {0, 0, 2, 0}, {10, 20, 30, 1}};
  ASSERT_EQ(defect(second), std::nullopt);
  scene.layers.push_back(second);
  EXPECT_EQ(subject_of(scene).low, glm::dvec3(6, 20, 30));
  EXPECT_EQ(subject_of(scene).high, glm::dvec3(101, 202, 303));
  EXPECT_EQ(subject_of(Scene{}).low, glm::dvec3(0));
}

}  // namespace navigation_test
}  // namespace tureen
