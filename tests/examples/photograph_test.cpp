// The photographs for training the example.
#include "examples/photograph.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>

#include "base/output.hpp"
#include "examples/curve.hpp"
#include "examples/nerf_synthetic.hpp"
#include "examples/parallel.hpp"
#include "examples/shapes.hpp"
#include "examples/still_life.hpp"
#include "formats/dataset/dataset.hpp"
#include "image/png.hpp"

namespace tureen::example {
namespace photograph_test {

const Studio& studio() {
  static const Studio made(still_life(), draft_light);
  return made;
}

/// A square in the plane y = 0, |x|, |z| <= 1, that faces up.
Surface square(std::function<Paint(const SurfacePoint&)> paint) {
  return {.position = [](glm::dvec2 uv) { return glm::dvec3(2 * uv.y - 1, 0, 2 * uv.x - 1); },
          .paint = std::move(paint),
          .columns = 2,
          .rows = 2,
          .cut_out = true};
}

Camera from_above(int size) { return look_at({0, 10, 0}, {0, 0, 0}, {0, 0, -1}, 0.3, size, size); }

TEST(InParallel, DoesEveryPieceOnceAndPassesOnWhatIsThrown) {
  std::vector<std::atomic<int>> done(1000);
  in_parallel(1000, 3, [&](int i) { ++done[i]; });
  for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1);
  EXPECT_THROW(in_parallel(1000, 3,
                           [](int i) {
                             if (i == 500) throw std::runtime_error("no");
                           }),
               std::runtime_error);
}

/// The unit sphere with a uniform paint.
Model sphere(const Paint& paint) {
  std::vector<glm::dvec3> half_circle;
  for (int i = 0; i <= 32; ++i) {
    const double angle = std::numbers::pi * i / 32;
    half_circle.emplace_back(std::sin(angle), -std::cos(angle), 0.0);
  }
  Model model;
  model.add({.position = turned(Curve(half_circle), {}),
             .paint = [paint](const SurfacePoint&) { return paint; },
             .columns = 64,
             .rows = 32,
             .closed = true});
  return model;
}

TEST(LightMap, IsTheLightAtItsPointsAndCloseToItBetween) {
  const Model model = sphere({});
  const RayCaster caster(model);
  const Light light(model, caster, draft_light.light);
  const LightMap map(model, light, 0.1, 2), fine(model, light, 0.05, 1);
  const auto error = [&](const LightMap& approximate, glm::dvec2 uv) {
    const glm::dvec3 exact = light.falling(0, model.point(0, uv));
    return glm::distance(approximate.falling(0, uv), exact) / glm::length(exact);
  };
  EXPECT_LT(error(map, {0, 0}), 1e-6);  // stored as floats
  EXPECT_LT(error(map, {1, 1}), 1e-6);
  double sum = 0, fine_sum = 0;
  for (int i = 0; i < 100; ++i) {
    const int column = i % 10, row = i / 10;
    const glm::dvec2 uv((column + 0.37) / 10, (row + 0.41) / 10);
    sum += error(map, uv) / 100;
    fine_sum += error(fine, uv) / 100;
  }
  // A single sphere has no shadows. Light follows the cosine, whose deviation from linear over a
  // cell of 0.1 is 0.1^2 / 8 in each direction.
  EXPECT_LT(sum, 2 * 0.1 * 0.1 / 8);
  EXPECT_LT(fine_sum, 0.5 * sum);
}

TEST(Photograph, IsTheSameFromAnyNumberOfThreads) {
  StudioOptions options = draft_light;
  options.threads = 3;
  const Studio other(still_life(), options);
  const Camera camera = example_cameras(3, 48)[1];
  const Image8 once = studio().photograph(camera, 2), again = studio().photograph(camera, 2);
  EXPECT_EQ(once.pixels, again.pixels);
  EXPECT_EQ(once.pixels, other.photograph(camera, 2).pixels);
}

TEST(Photograph, AlphaIsThePartThatIsCovered) {
  // The square's right half is cut away. The camera is shifted so that the left border and the cut
  // are at quarters of pixels, the borders of the strata.
  Model model;
  model.add(square([](const SurfacePoint& at) {
    return Paint{.albedo = {0.5, 0.3, 0.1}, .hole = at.position.x > 0};
  }));
  const Studio small(std::move(model), draft_light);
  Camera camera = from_above(32);
  camera.fx = camera.fy = 80;  // 8 pixels per unit
  camera.cx = 16.25;           // x = -1 at 8.25, x = 0 at 16.25
  const Image8 image = small.photograph(camera, 4);
  EXPECT_EQ(image.at(7, 16).a, 0);
  EXPECT_EQ(image.at(8, 16).a, 191);  // 3/4
  EXPECT_EQ(image.at(9, 16).a, 255);
  EXPECT_EQ(image.at(15, 16).a, 255);
  EXPECT_EQ(image.at(16, 16).a, 64);  // 1/4
  EXPECT_EQ(image.at(17, 16).a, 0);
  // Straight alpha: colours do not fade with the coverage. Light on a single square is uniform.
  EXPECT_EQ(glm::u8vec3(image.at(8, 16)), glm::u8vec3(image.at(12, 16)));
  EXPECT_EQ(glm::u8vec3(image.at(16, 16)), glm::u8vec3(image.at(12, 16)));
  EXPECT_GT(image.at(12, 16).r, image.at(12, 16).g);
  EXPECT_GT(image.at(12, 16).g, image.at(12, 16).b);
}

/// The normal of the unit sphere where its photograph from `direction` is brightest: the mean over
/// pixels with nearly the largest brightness.
glm::dvec3 brightest_normal(const Studio& studio_of_sphere, glm::dvec3 direction) {
  const Camera camera = look_at(8.0 * direction, {0, 0, 0}, {0, 1, 0}, 0.28, 96, 96);
  const Image8 image = studio_of_sphere.photograph(camera, 4);
  int most = 0;
  for (const auto& pixel : image.pixels)
    if (pixel.a == 255) most = std::max(most, int(pixel.g));
  glm::dvec3 sum(0);
  const glm::dvec3 eye = camera.eye();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (image.at(x, y).a < 255 || image.at(x, y).g < most - 12) continue;
      const glm::dvec3 view((x + 0.5 - camera.cx) / camera.fx, (camera.cy - y - 0.5) / camera.fy,
                            -1);
      const glm::dvec3 d = glm::normalize(camera.world_from_view_rotation() * view);
      const double b = glm::dot(eye, d), c = glm::dot(eye, eye) - 1;
      sum += eye + (-b - std::sqrt(std::max(0.0, b * b - c))) * d;
    }
  return glm::normalize(sum);
}

TEST(Photograph, TheHighlightMovesWithTheEye) {
  // A dark glazed sphere is brightest half way between the eye and the window.
  const Studio dark(sphere({.albedo = glm::dvec3(0.02), .gloss = 0.6}), draft_light);
  const glm::dvec3 window = glm::normalize(glm::dvec3(-0.62, 0.74, 0.36));
  for (const glm::dvec3 seen_from :
       {glm::dvec3(0, 0.3, 1), glm::dvec3(-1, 0.2, -0.2), glm::dvec3(0.3, 1, 0.3)}) {
    const glm::dvec3 eye = glm::normalize(seen_from);
    const glm::dvec3 found = brightest_normal(dark, eye);
    // A pixel is 0.024 wide, and the sky's reflection has a gradient.
    EXPECT_LT(glm::distance(found, glm::normalize(eye + window)), 0.05);
  }
}

TEST(ExampleCameras, HoldTheWholeStillLifeFromEverySide) {
  constexpr int size = 48;
  const std::vector<Camera> cameras = example_cameras(24, size);
  double lowest = 1, highest = -1;
  glm::dvec3 mean(0);
  for (const Camera& camera : cameras) {
    const glm::dvec3 direction = glm::normalize(camera.eye());
    lowest = std::min(lowest, direction.y);
    highest = std::max(highest, direction.y);
    mean += direction / double(cameras.size());
    const Image8 image = studio().photograph(camera, 1);
    int covered = 0, on_the_border = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        if (image.at(x, y).a == 0) continue;
        ++covered;
        on_the_border += x == 0 || y == 0 || x == size - 1 || y == size - 1;
      }
    EXPECT_EQ(on_the_border, 0) << camera.name;
    EXPECT_GT(covered, size * size / 6) << camera.name;
  }
  // For any counts, test views differ from training views.
  for (const int count : {4, 24})
    for (const Camera& test : example_cameras(count, size, 0.5))
      for (const Camera& camera : cameras)
        EXPECT_GT(glm::distance(test.eye(), camera.eye()), 0.1) << test.name << ' ' << camera.name;
  EXPECT_LT(lowest, 0.1);
  EXPECT_GT(highest, 0.9);
  EXPECT_LT(std::hypot(mean.x, mean.z), 0.1);  // directions are distributed evenly
}

TEST(Transforms, AreReadAsTheSameCamerasWithZUp) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "tureen_transforms";
  std::filesystem::remove_all(folder);
  for (const auto& [split, count] : {std::pair("train", 3), std::pair("test", 2)}) {
    const std::vector<Camera> cameras = example_cameras(count, 8);
    std::filesystem::create_directories(folder / split);
    for (const Camera& camera : cameras) {
      Output output(folder / split / (camera.name + ".png"));
      output.write(encode_png(Image8(8, 8)));
      output.commit();
    }
    write_transforms(folder, split, cameras);
  }
  const Dataset dataset = read_dataset(folder);
  std::filesystem::remove_all(folder);
  EXPECT_EQ(dataset.up, glm::vec3(0, 0, 1));
  ASSERT_EQ(dataset.train.size(), 3u);
  ASSERT_EQ(dataset.test.size(), 2u);
  const std::vector<Camera> cameras = example_cameras(3, 8);
  for (int i = 0; i < 3; ++i) {
    const Camera &wanted = cameras[i], &read = dataset.train[i].camera;
    // An angle and its tangent, in double.
    EXPECT_NEAR(read.fx, wanted.fx, 1e-9);
    EXPECT_NEAR(read.fy, wanted.fy, 1e-9);
    EXPECT_EQ(read.cx, wanted.cx);
    EXPECT_EQ(read.cy, wanted.cy);
    for (const glm::dvec3 p :
         {glm::dvec3(0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}) {
      const glm::dvec4 before(p, 1), after(p.x, -p.z, p.y, 1);
      EXPECT_EQ(wanted.view_from_world * before, with_z_up(wanted).view_from_world * after);
      EXPECT_LT(glm::distance(wanted.view_from_world * before, read.view_from_world * after), 1e-6);
    }
  }
}

}  // namespace photograph_test
}  // namespace tureen::example
