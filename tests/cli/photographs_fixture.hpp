// For tests that run the program on photographs: those that it took itself.
#pragma once

#include <glm/matrix.hpp>

#include "cli/program_fixture.hpp"
#include "soup/camera.hpp"

namespace tureen::test {

class ProgramWithPhotographs : public Program {
 protected:
  static constexpr int width = 64, height = 48;

  static nlohmann::json frame(const std::string& file, glm::dvec3 eye) {
    const Camera camera = look_at(eye, {0, 0, 0}, {0, 0, 1}, 0.8, width, height);
    const glm::dmat4 world_from_view = glm::inverse(camera.view_from_world);
    nlohmann::json rows = nlohmann::json::array();
    for (int row = 0; row < 4; ++row)
      rows.push_back({world_from_view[0][row], world_from_view[1][row], world_from_view[2][row],
                      world_from_view[3][row]});
    return {{"file_path", file}, {"transform_matrix", rows}};
  }

  /// The dataset "data", as NeRF-synthetic has them: two views to test, one to train, all of them
  /// pictures that the program draws of `scene`.
  void photograph(const std::string& scene) const {
    std::filesystem::create_directories(folder / "data/test");
    std::filesystem::create_directories(folder / "data/train");
    const Camera camera = look_at({3, 0, 1}, {0, 0, 0}, {0, 0, 1}, 0.8, width, height);
    nlohmann::json test{{"fl_x", camera.fx}, {"fl_y", camera.fy}, {"cx", camera.cx},
                        {"cy", camera.cy},   {"w", width},        {"h", height}};
    nlohmann::json train = test;
    test["frames"] = {frame("test/r_0.png", {3, 0, 1}), frame("test/r_1.png", {0, -3, 0.5})};
    train["frames"] = {frame("train/r_0.png", {-2, 2, 1})};
    write("data/transforms_test.json", test.dump());
    write("data/transforms_train.json", train.dump());
    for (const char* split : {"test", "train"}) {
      const std::string which = std::string("data/transforms_") + split + ".json:all";
      const ChildResult drawn =
          run({"render", scene, "--camera", which, "-o", std::string("data/") + split + "/r_%d.png",
               "--context", "osmesa"});
      ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
    }
    ASSERT_TRUE(exists("data/test/r_1.png"));
  }
};

}  // namespace tureen::test
