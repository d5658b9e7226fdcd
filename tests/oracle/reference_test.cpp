// The oracle against images of another renderer: reference/render_splats.py, written from the
// papers by someone who had not seen our kernels. `python3 make_scenes.py` there writes its scenes
// and images.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "oracle/oracle.hpp"
#include "scene/scene.hpp"

namespace tureen::test {
namespace reference_test {

using Json = nlohmann::json;

glm::vec3 vector_from(const Json& values) {
  return {values.at(0).get<float>(), values.at(1).get<float>(), values.at(2).get<float>()};
}

std::vector<glm::vec3> vectors_from(const Json& list) {
  std::vector<glm::vec3> result;
  for (const Json& each : list) result.push_back(vector_from(each));
  return result;
}

/// From w, x, y, z.
std::vector<glm::quat> rotations_from(const Json& list) {
  std::vector<glm::quat> result;
  for (const Json& q : list)
    result.emplace_back(glm::normalize(glm::dquat(q.at(0).get<double>(), q.at(1).get<double>(),
                                                  q.at(2).get<double>(), q.at(3).get<double>())));
  return result;
}

TriangleWindows windows_from(const Json& splats) {
  TriangleWindows windows;
  for (const Json& triangle : splats.at("corners"))
    for (const Json& corner : triangle) windows.corners.push_back(vector_from(corner));
  windows.sigma = splats.at("sigma").get<std::vector<float>>();
  windows.opacity = splats.at("opacity").get<std::vector<float>>();
  return windows;
}

Gaussians gaussians_from(const Json& splats, bool flat) {
  Gaussians gaussians;
  gaussians.centers = vectors_from(splats.at("centres"));
  gaussians.rotations = rotations_from(splats.at("rotations"));
  for (const Json& scales : splats.at("scales"))
    gaussians.scales.emplace_back(scales.at(0).get<float>(), scales.at(1).get<float>(),
                                  flat ? 0.0f : scales.at(2).get<float>());
  gaussians.opacity = splats.at("opacity").get<std::vector<float>>();
  gaussians.flat = flat;
  return gaussians;
}

NeuralDensities densities_from(const Json& splats) {
  NeuralDensities densities;
  densities.centers = vectors_from(splats.at("centres"));
  densities.rotations = rotations_from(splats.at("rotations"));
  densities.semi_axes = vectors_from(splats.at("scales"));
  for (std::size_t i = 0; i < densities.centers.size(); ++i) {
    for (const Json& w : splats.at("w").at(i))
      for (const Json& value : w) densities.networks.push_back(value);
    for (const char* layer : {"b1", "a"})
      for (const Json& value : splats.at(layer).at(i)) densities.networks.push_back(value);
    densities.networks.push_back(splats.at("b2").at(i));
  }
  return densities;
}

struct Case {
  const char* name;  // of the file and the test
  const char* profile;
};

SplatKernel kernel_from(const std::string& name, const Json& splats) {
  if (name == "windows") return windows_from(splats);
  if (name == "neural") return densities_from(splats);
  return gaussians_from(splats, name == "discs");
}

Camera camera_from(const Json& json) {
  Camera camera;
  camera.width = json.at("width");
  camera.height = json.at("height");
  camera.fx = json.at("fx");
  camera.fy = json.at("fy");
  camera.cx = json.at("cx");
  camera.cy = json.at("cy");
  glm::dmat4 world_from_camera(1.0);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      world_from_camera[column][row] = json.at("world_from_camera").at(row).at(column);
  camera.view_from_world = glm::inverse(world_from_camera);
  return camera;
}

class AnotherRenderer : public testing::TestWithParam<Case> {};

TEST_P(AnotherRenderer, GivesTheSameImage) {
  const std::string file =
      std::string(TUREEN_SOURCE_DIR) + "/tests/oracle/reference/" + GetParam().name + ".json";
  const Json json = Json::parse(std::ifstream(file));
  Splats splats{.kernel = kernel_from(GetParam().name, json.at("splats")),
                .color = {.degree = json.at("profile").at("sh_degree")},
                .profile = *profile_named(GetParam().profile)};
  for (const Json& of_splat : json.at("splats").at("sh"))
    for (const Json& coefficient : of_splat)
      splats.color.coefficients.push_back(vector_from(coefficient));
  Scene scene;
  scene.info.background = glm::vec3(0.0f);
  scene.layers.push_back({.primitives = std::move(splats)});
  ASSERT_EQ(defect(scene.layers[0]), std::nullopt);

  const OracleImage image = render_oracle(scene, {camera_from(json.at("camera"))}, {});
  const auto alpha = json.at("alpha").get<std::vector<double>>();
  const auto color = json.at("image").get<std::vector<double>>();
  ASSERT_EQ(image.splat_alpha.size(), alpha.size());
  // Rotations are rounded to floats after they are normalised, and ImageF holds floats. A change of
  // the parameters by a rounding changes the image by up to 4e-5.
  constexpr double tolerance = 4e-5;
  std::size_t different = 0;
  double sum = 0;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    sum += alpha[i];
    // Negated, so that NaN differs.
    if (!(std::abs(image.splat_alpha[i] - alpha[i]) < tolerance)) ++different;
    for (std::size_t channel = 0; channel < 3; ++channel)
      if (!(std::abs(double(image.color.pixels[i][int(channel)]) -
                     std::clamp(color[3 * i + channel], 0.0, 1.0)) < tolerance))
        ++different;
  }
  EXPECT_GT(sum / double(alpha.size()), 0.1) << "the image shows too little";
  EXPECT_EQ(different, 0u);
}

INSTANTIATE_TEST_SUITE_P(, AnotherRenderer,
                         testing::Values(Case{"windows", "triangle-splatting"},
                                         Case{"gaussians", "3dgs"}, Case{"discs", "2dgs"},
                                         Case{"neural", "splatnet"}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace reference_test
}  // namespace tureen::test
