// The installed COLMAP on photographs that the test draws: a corner of a room with a box.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

#include "base/output.hpp"
#include "base/platform/process.hpp"
#include "formats/dataset/dataset.hpp"
#include "image/png.hpp"
#include "jobs/cameras/camera_run.hpp"
#include "jobs/cameras/known_cameras.hpp"
#include "tests/cli/transforms.hpp"

namespace tureen {
namespace real_colmap_test {

namespace fs = std::filesystem;

constexpr int width = 320, height = 240, count = 20;

/// A pseudo-random grey value of a cell, 0 .. 1.
double grey(int x, int y, int layer) {
  std::uint32_t h = std::uint32_t(x) * 73856093u ^ std::uint32_t(y) * 19349663u ^
                    std::uint32_t(layer) * 83492791u;
  h = (h ^ (h >> 13)) * 1274126177u;
  return double((h ^ (h >> 16)) & 0xffff) / 65535;
}

/// Cells of three sizes.
double texture(glm::dvec2 place, int surface) {
  double value = 0;
  for (const double size : {0.5, 0.2, 0.08})
    value += grey(int(std::floor(place.x / size)), int(std::floor(place.y / size)),
                  surface + int(100 * size)) /
             3;
  return value;
}

/// The box [-0.7, 0.7]^2 x [0, 1] on the floor z = 0, before the walls x = -3 and y = -3.
constexpr double side = 0.7, top = 1.0, wall = -3.0;

double seen(glm::dvec3 eye, glm::dvec3 ray) {
  double nearest = std::numeric_limits<double>::infinity(), color = 0;
  const auto hit = [&](int axis, double at, int surface, auto&& is_inside) {
    const double distance = (at - eye[axis]) / ray[axis];
    const glm::dvec3 place = eye + distance * ray;
    if (!(distance > 1e-6) || distance > nearest || !is_inside(place)) return;
    nearest = distance;
    color = texture({place[(axis + 1) % 3], place[(axis + 2) % 3]}, surface);
  };
  const auto everywhere = [](glm::dvec3) { return true; };
  const auto on_box = [](glm::dvec3 p) {
    return std::abs(p.x) < side + 1e-9 && std::abs(p.y) < side + 1e-9 && p.z > -1e-9 &&
           p.z < top + 1e-9;
  };
  hit(2, 0, 1, everywhere);
  hit(0, wall, 2, everywhere);
  hit(1, wall, 3, everywhere);
  for (const double s : {-side, side}) {
    hit(0, s, 4 + (s > 0), on_box);
    hit(1, s, 6 + (s > 0), on_box);
  }
  hit(2, top, 8, on_box);
  return color;
}

/// Cameras on a quarter of a circle that look at the box.
std::vector<Camera> cameras() {
  std::vector<Camera> all;
  for (int i = 0; i < count; ++i) {
    const double angle = 1.5 * i / (count - 1);
    all.push_back(look_at({4 * std::cos(angle), 4 * std::sin(angle), 1.5 + 0.3 * (i % 3)},
                          {0, 0, 0.5}, {0, 0, 1}, 0.9, width, height));
  }
  return all;
}

Image8 photograph(const Camera& camera) {
  Image8 image(width, height);
  const glm::dmat3 axes = camera.world_from_view_rotation();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (const double dx : {0.25, 0.75})
        for (const double dy : {0.25, 0.75})
          sum += seen(camera.eye(), axes * glm::dvec3((x + dx - camera.cx) / camera.fx,
                                                      (camera.cy - y - dy) / camera.fy, -1));
      image.at(x, y) = glm::u8vec4(glm::u8vec3(std::uint8_t(255 * sum / 4)), 255);
    }
  return image;
}

double distance_to_surfaces(glm::dvec3 p) {
  const glm::dvec3 q =
      glm::abs(p - glm::dvec3(0, 0, 0.5 * top)) - glm::dvec3(side, side, 0.5 * top);
  const double box =
      std::abs(glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0));
  return std::min({std::abs(p.z), std::abs(p.x - wall), std::abs(p.y - wall), box});
}

class ThoroughCameras : public testing::Test {
 protected:
  void SetUp() override {
    if (!is_on_path("colmap")) GTEST_SKIP() << "colmap is not installed";
    folder =
        fs::path(testing::TempDir()) /
        (std::string("tureen_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder);
    fs::create_directories(folder / "photos");
    for (int i = 0; i < count; ++i)
      write_file(folder / "photos" / name(i), encode_png(photograph(taken[std::size_t(i)])));
    events = {.progress = [](const char*, double, double) {}, .note = [](const std::string&) {}};
  }
  void TearDown() override { fs::remove_all(folder); }
  static std::string name(int i) { return "p" + std::to_string(10 + i) + ".png"; }

  fs::path folder;
  std::vector<Camera> taken = cameras();
  CameraEvents events;
};

TEST_F(ThoroughCameras, AreThoseOfTheDrawnPhotographs) {
  const CameraOptions options{.photographs = folder / "photos", .dataset = folder / "dataset"};
  const CameraOutcome outcome = find_cameras(options, events);
  ASSERT_TRUE(outcome.is_written);
  EXPECT_EQ(outcome.quality.registered, std::size_t(count));
  EXPECT_LT(outcome.quality.error_px, 1);
  EXPECT_GT(outcome.quality.parallax_degrees, 5);
  const DatasetSummary summary = read_dataset_summary(options.dataset);
  std::map<std::string, glm::dvec3> eyes;
  for (const auto* views : {&summary.train, &summary.test})
    for (const auto& view : *views) eyes[view.camera.name] = view.camera.eye();
  // COLMAP chooses the world, so distances are compared, by the scale of the longest one. 2 %: its
  // error with features of some tenths of a pixel, in photographs of 320 pixels.
  const double scale = glm::distance(eyes[name(0)], eyes[name(count - 1)]) /
                       glm::distance(taken.front().eye(), taken.back().eye());
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < i; ++j)
      EXPECT_NEAR(glm::distance(eyes[name(i)], eyes[name(j)]) / scale,
                  glm::distance(taken[std::size_t(i)].eye(), taken[std::size_t(j)].eye()), 0.08);
}

TEST_F(ThoroughCameras, ThatAreKnownGetPointsOnTheSurfaces) {
  nlohmann::json document = test::transforms_of(taken[0]);
  for (int i = 0; i < count; ++i)
    document["frames"].push_back(test::frame_of("photos/" + name(i), taken[std::size_t(i)]));
  write_file(folder / "transforms.json", document.dump());
  const PointOutcome outcome = add_points({.photographs = {}, .dataset = folder}, events);
  EXPECT_GT(outcome.points, 500u);
  EXPECT_LT(outcome.error_px, 1);
  const DatasetSummary summary = read_dataset_summary(folder);
  ASSERT_EQ(summary.points.size(), outcome.points);
  std::size_t on_surfaces = 0;
  // The smallest cell of the texture, about five pixels.
  for (const DatasetPoint& point : summary.points)
    on_surfaces += distance_to_surfaces(point.position) < 0.08;
  EXPECT_GT(double(on_surfaces), 0.9 * double(outcome.points));
}

}  // namespace real_colmap_test
}  // namespace tureen
