#include "camera/up_axis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>

#include "formats/scene_file.hpp"

namespace tureen {
namespace up_axis_test {

/// Upright cameras on an arc around `up`, looking down by 30 degrees.
std::vector<Camera> arc(const glm::dvec3& up, double turns) {
  const glm::dvec3 side = glm::normalize(glm::cross(up, glm::dvec3(0.3, 0.5, 0.9)));
  const glm::dvec3 front = glm::cross(side, up);
  std::vector<Camera> cameras;
  for (int i = 0; i < 24; ++i) {
    const double angle = 6.283185307179586 * turns * i / 24;
    const glm::dvec3 eye = std::cos(angle) * front + std::sin(angle) * side + std::tan(0.52) * up;
    cameras.push_back(look_at(eye, {}, up, 0.7, 640, 480));
  }
  return cameras;
}

TEST(UpAxis, TheFileHasTheFirstWord) {
  const std::vector<Camera> cameras = arc({0, 0, 1}, 1);
  const UpGuess guess = guess_up({.stored = {0, -2, 0}, .cameras = cameras});
  EXPECT_EQ(guess.axis, glm::dvec3(0, -1, 0));
  EXPECT_EQ(guess.reason, UpGuess::Reason::stored);
}

TEST(UpAxis, CamerasHeldUprightCorrectAnAssumption) {
  for (const double turns : {1.0, 0.4})
    for (const glm::dvec3 up : {glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0), glm::dvec3(1, 0, 0)}) {
      const std::vector<Camera> cameras = arc(up, turns);
      const UpGuess guess =
          guess_up({.stored = {0, 1, 0}, .stored_is_assumed = true, .cameras = cameras});
      EXPECT_EQ(guess.axis, up) << describe(guess);
      EXPECT_EQ(guess.reason, UpGuess::Reason::cameras_near_axis);
      EXPECT_EQ(guess.cameras, 24u);
    }
}

TEST(UpAxis, ASceneThatNobodyAlignedKeepsTheMeanItself) {
  const glm::dvec3 up = glm::normalize(glm::dvec3(1, 1, 1));
  const std::vector<Camera> cameras = arc(up, 1);
  const UpGuess guess = guess_up({.cameras = cameras});
  EXPECT_LT(glm::length(guess.axis - up), 1e-9);
  EXPECT_EQ(guess.reason, UpGuess::Reason::cameras);
}

TEST(UpAxis, CamerasThatDisagreeSayNothing) {
  std::vector<Camera> cameras = arc({0, 0, 1}, 1);
  for (const Camera& camera : arc({0, 0, -1}, 1)) cameras.push_back(camera);
  const UpGuess guess =
      guess_up({.stored = {0, 1, 0}, .stored_is_assumed = true, .cameras = cameras});
  EXPECT_EQ(guess.axis, glm::dvec3(0, 1, 0));
  EXPECT_EQ(guess.reason, UpGuess::Reason::assumed);
}

TEST(UpAxis, FlatScenesLie) {
  const UpEvidence evidence{
      .stored = {0, 1, 0}, .stored_is_assumed = true, .cameras = {}, .extent = {10, 12, 2}};
  EXPECT_EQ(guess_up(evidence).axis, glm::dvec3(0, 0, 1));
  EXPECT_EQ(guess_up(evidence).reason, UpGuess::Reason::flat);
  UpEvidence along = evidence;
  along.stored = {0, 0, -1};  // the same line: the reader's sign stays
  EXPECT_EQ(guess_up(along).axis, glm::dvec3(0, 0, -1));
  UpEvidence cube = evidence;
  cube.extent = {1, 1, 0.9};
  EXPECT_EQ(guess_up(cube).axis, glm::dvec3(0, 1, 0));
}

TEST(UpAxis, NothingAndNonsenseGiveY) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Camera broken;
  broken.view_from_world = glm::dmat4(nan);
  const std::vector<Camera> cameras(5, broken);
  EXPECT_EQ(guess_up({}).axis, glm::dvec3(0, 1, 0));
  EXPECT_EQ(guess_up({.stored = {nan, 0, 0}, .cameras = cameras, .extent = {nan, 1, 1}}).axis,
            glm::dvec3(0, 1, 0));
}

/// The evidence after the scene was written and read.
UpEvidence through_file(const Scene& scene, const std::string& name, Scene& back) {
  // A name for this build: other builds may run the test at the same time.
  const std::string path = TUREEN_BINARY_DIR "/up_axis_" + name;
  write_scene(scene, path);
  back = read_scene(path);
  std::filesystem::remove(path);
  return evidence_of(back, subject_of(back));
}

TEST(UpAxis, ReadersReportWhatTheyAssumed) {
  Scene scene = scene_of(TriangleSoup{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}},
                                      .triangles = {{0, 1, 2}},
                                      .appearance = FaceColors{{glm::vec4(1)}}});
  Scene back;
  scene.info.up = {0, 1, 0};
  for (const char* name : {"a.off", "a.ply"}) {
    const UpEvidence evidence = through_file(scene, name, back);
    EXPECT_TRUE(evidence.stored_is_assumed) << name;
    EXPECT_EQ(evidence.extent, glm::dvec3(1, 2, 0));
  }
  const UpEvidence evidence = through_file(scene, "a.glb", back);
  EXPECT_FALSE(evidence.stored_is_assumed);
  EXPECT_EQ(evidence.stored, glm::dvec3(0, 1, 0));
}

TEST(UpAxis, ReasonsInEnglish) {
  EXPECT_EQ(describe({{0, -1, 0}, UpGuess::Reason::stored}), "the file stores -y as the up axis");
  EXPECT_EQ(describe({{0, 0, 1}, UpGuess::Reason::cameras_near_axis, 24, 11.6}),
            "the mean of the up axes of 24 cameras points 12 degrees from z, the assumed up axis");
  EXPECT_EQ(describe({{0, 0, 1}, UpGuess::Reason::flat}),
            "the scene is flat along z, the assumed up axis; it may also be -z");
}

TEST(UpAxis, AxesHaveNames) {
  EXPECT_EQ(axis_name({0, 0, 3}), "z");
  EXPECT_EQ(axis_name({-1, 0, 0}), "-x");
  EXPECT_EQ(axis_name({0, 0, 0}), "nothing");
}

}  // namespace up_axis_test
}  // namespace tureen
