// `tureen train` on photographs of a coloured ball, 32 pixels a side.
#pragma once

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "tests/cli/program_fixture.hpp"
#include "tests/cli/transforms.hpp"

namespace tureen::test {

class Train : public Program {
 protected:
  static constexpr int size = 32;

  /// Behind the ball. A place is black with a brown lower half.
  enum class Behind { transparent, white, place };

  /// The unit ball; its colour is the surface normal. One ray a pixel.
  static Image8 image(const Camera& camera, Behind behind) {
    Image8 image(size, size,
                 behind == Behind::transparent ? glm::u8vec4(0)
                 : behind == Behind::white     ? glm::u8vec4(255)
                                               : glm::u8vec4(0, 0, 0, 255));
    if (behind == Behind::place)
      std::fill(image.pixels.begin() + size * size / 2, image.pixels.end(),
                glm::u8vec4(90, 60, 30, 255));
    const glm::dmat3 axes = camera.world_from_view_rotation();
    const glm::dvec3 eye = camera.eye();
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const glm::dvec3 ray =
            glm::normalize(axes * glm::dvec3((x + 0.5 - camera.cx) / camera.fx,
                                             (camera.cy - y - 0.5) / camera.fy, -1.0));
        const double along = -glm::dot(eye, ray);
        const double inside = 1 - glm::dot(eye, eye) + along * along;
        if (inside < 0) continue;
        const glm::dvec3 normal = eye + (along - std::sqrt(inside)) * ray;
        image.at(x, y) = glm::u8vec4(glm::dvec4(127.5 * (normal + 1.0), 255));
      }
    return image;
  }

  void write_split(const std::string& split, int count, double turn, Behind behind) const {
    std::filesystem::create_directories(folder / "ball" / split);
    nlohmann::json document;
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * 3.14159265358979 * (i + turn) / count;
      const Camera camera = look_at({4 * std::cos(angle), 4 * std::sin(angle), i % 2 ? 1.5 : -0.5},
                                    {0, 0, 0}, {0, 0, 1}, 0.7, size, size);
      const std::string name = split + "/r_" + std::to_string(i) + ".png";
      write_png("ball/" + name, image(camera, behind));
      if (i == 0) document = transforms_of(camera);
      document["frames"].push_back(frame_of(name, camera));
    }
    write("ball/transforms_" + split + ".json", document.dump());
  }

  void make_dataset(Behind behind = Behind::transparent) const {
    write_split("train", 8, 0, behind);
    write_split("test", 2, 0.25, behind);
  }

  /// The first triangles: random, or as the other arguments say. By default they come from
  /// Gaussians, which take most of the time of a short run.
  enum class First { random, as_given };

  static std::vector<std::string> arguments(const std::string& output,
                                            const std::vector<std::string>& more = {},
                                            const std::string& steps = "40",
                                            First first = First::random) {
    // A GPU would compute other bits.
    std::vector<std::string> all{"train",   "ball", "-o",        output, "--triangles", "100",
                                 "--steps", steps,  "--threads", "2",    "--device",    "cpu"};
    if (first == First::random) all.insert(all.end(), {"--init", "random"});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  ChildResult train(const std::string& output, const std::vector<std::string>& more = {},
                    const std::string& steps = "40", First first = First::random) const {
    return run(arguments(output, more, steps, first));
  }
  std::string bytes(const std::string& name) const { return bytes_of_file(folder / name); }

  /// Whether the run of ball.glb has written its first record, which it does within 50 steps.
  bool has_begun() const { return bytes("ball.jsonl").find("\"loss\"") != std::string::npos; }

  struct Interrupted {
    ChildResult result;
    int steps = 0;
  };
  /// Runs the program with the arguments for a number of steps, which make ball.glb, and sends it
  /// SIGINT after its first record. If the run ends first, as it may on a busy machine, a longer
  /// one follows.
  Interrupted interrupted(
      int steps,
      const std::function<std::vector<std::string>(const std::string& steps)>& words) const {
    while (true) {
      Child child(words(std::to_string(steps)), folder);
      EXPECT_TRUE(child.wait_until([&] { return has_begun(); }));
      child.signal(SIGINT);
      const ChildResult result = child.wait();
      if (result.exit_code != 0 || steps > 100'000) return {result, steps};
      for (const char* name : {"ball.glb", "ball.jsonl"}) std::filesystem::remove(folder / name);
      steps *= 4;
    }
  }
  /// Every file in the test's folder, except the dataset and the streams.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      const std::string name = std::filesystem::relative(entry.path(), folder).string();
      if (entry.is_regular_file() && name.rfind("ball/", 0) != 0 && name.rfind("std", 0) != 0)
        names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
  }
};

}  // namespace tureen::test
