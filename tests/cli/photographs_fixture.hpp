// For tests that run the program on photographs, which it draws itself.
#pragma once

#include "scene/camera.hpp"
#include "tests/cli/program_fixture.hpp"
#include "tests/cli/transforms.hpp"

namespace tureen::test {

class ProgramWithPhotographs : public Program {
 protected:
  static constexpr int width = 64, height = 48;

  static Camera camera_at(glm::dvec3 eye) {
    return look_at(eye, {0, 0, 0}, {0, 0, 1}, 0.8, width, height);
  }

  /// Makes the dataset "data" in the layout of NeRF-synthetic: two test views, and some training
  /// views. All of them are images of `scene` by the program.
  void photograph(const std::string& scene, int training_views = 1) const {
    std::filesystem::create_directories(folder / "data/test");
    std::filesystem::create_directories(folder / "data/train");
    nlohmann::json test = transforms_of(camera_at({3, 0, 1}));
    nlohmann::json train = test;
    test["frames"] = {frame_of("test/r_0.png", camera_at({3, 0, 1})),
                      frame_of("test/r_1.png", camera_at({0, -3, 0.5}))};
    train["frames"] = nlohmann::json::array();
    for (int i = 0; i < training_views; ++i)
      train["frames"].push_back(
          frame_of("train/r_" + std::to_string(i) + ".png", camera_at({-2, 2 - 0.1 * i, 1})));
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
