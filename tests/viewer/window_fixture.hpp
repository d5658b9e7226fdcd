// Sessions of the window as a person makes them: actions, and a fixture that replays them with the
// example in a folder of its own.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/input.hpp"
#include "formats/scene_file.hpp"
#include "image/png.hpp"
#include "tests/cli/child.hpp"
#include "viewer/files/session.hpp"
#include "viewer/messages.hpp"

namespace tureen::test {
namespace window_test {

namespace fs = std::filesystem;
using namespace tureen::viewer;

/// A sequence of user actions. Times are on the session's clock.
class Person {
 public:
  explicit Person(glm::ivec2 window = {720, 450}) { session_.window = window; }

  Person& wait() { return add(AwaitRest{}); }
  Person& press(Key key) { return add(KeyChanged{key, true}).add(KeyChanged{key, false}); }
  Person& begin_press(Key key) { return add(KeyChanged{key, true}); }
  Person& end_press(Key key) { return add(KeyChanged{key, false}); }
  Person& press_with_control(Key key, std::optional<Key> too = {}) {
    add(KeyChanged{Key::control, true});
    if (too) add(KeyChanged{*too, true});
    press(key);
    if (too) add(KeyChanged{*too, false});
    return add(KeyChanged{Key::control, false});
  }
  Person& hold(Key key, double seconds) {
    add(KeyChanged{key, true});
    now_ += seconds;
    return add(KeyChanged{key, false});
  }
  Person& drag(Button button, glm::dvec2 from, glm::dvec2 to) {
    add(PointerMoved{from.x, from.y}).add(ButtonChanged{button, true});
    for (int i = 1; i <= 5; ++i) {
      const glm::dvec2 at = from + (to - from) * (i / 5.0);
      add(PointerMoved{at.x, at.y});
    }
    return add(ButtonChanged{button, false});
  }
  Person& begin_drag(glm::dvec2 at) { return point(at).add(ButtonChanged{Button::left, true}); }
  Person& end_drag() { return add(ButtonChanged{Button::left, false}); }
  Person& point(glm::dvec2 at) { return add(PointerMoved{at.x, at.y}); }
  Person& click(glm::dvec2 at) { return drag(Button::left, at, at); }
  /// Clicks a control (viewer/gui/item_places.hpp).
  Person& click(const std::string& control) { return add(ControlClicked{control}).wait(); }
  /// The same without waiting for the end of what it begins.
  Person& click_at_once(const std::string& control) { return add(ControlClicked{control}); }
  Person& drag_control(const std::string& control, glm::dvec2 by) {
    return add(ControlClicked{control, {by.x, by.y}}).wait();
  }
  Person& hold_control() { return add(KeyChanged{Key::control, true}); }
  Person& release_control() { return add(KeyChanged{Key::control, false}); }
  /// In the field that has the keys.
  Person& select_all() { return press_with_control(Key::a); }
  /// Waits until the notes have disappeared.
  Person& without_notes() { return hold(Key::super, Messages::note_seconds + 1); }
  Person& turn_wheel(double away) { return add(Scrolled{0, away}); }
  Person& drop(const std::string& path) { return drop_all({path}); }
  Person& drop_all(std::vector<std::string> paths) { return add(FilesDropped{std::move(paths)}); }
  Person& double_click(glm::dvec2 at) { return click(at).click(at); }
  Person& type(const std::string& ascii) {
    for (const char letter : ascii) add(TextTyped{static_cast<unsigned char>(letter)});
    return press(Key::enter);
  }
  Person& resize(glm::ivec2 size) { return add(Resized{size.x, size.y}); }
  Person& replace(const std::string& file, const std::string& with) {
    return add(FileReplaced{.from = with, .to = file});
  }
  /// Adds a screenshot of the current window.
  Person& take(const std::string& name) { return add(WindowScreenshot{name + ".png"}); }
  /// Waits until loading and motion are finished, then adds a screenshot.
  Person& look(const std::string& name) { return wait().add(WindowScreenshot{name + ".png"}); }

  /// Moves the last event into the frame of the one before.
  Person& at_once() {
    now_ = session_.events.back().seconds = (session_.events.end() - 2)->seconds;
    return *this;
  }

  const Session& session() const { return session_; }

 private:
  Person& add(Event event) {
    now_ += 0.02;
    session_.events.push_back({now_, std::move(event)});
    return *this;
  }
  Session session_;
  double now_ = 0;
};

constexpr const char* square = "OFF\n4 2 0\n-2 -2 0.3\n2 -2 0.3\n2 2 0.3\n-2 2 0.3\n";

/// A square of this colour, which cuts the example.
inline void write_square(const fs::path& file, const std::string& color) {
  std::ofstream(file) << square << "3 0 1 2 " << color << "\n3 0 2 3 " << color << "\n";
}

class Window : public testing::Test {
 protected:
  Window()
      : folder_(fs::path(testing::TempDir()) / "window" /
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    fs::copy(fs::path(TUREEN_SOURCE_DIR) / "examples/soup.glb", folder_ / "soup.glb");
    ::setenv("XDG_CONFIG_HOME", (folder_ / "config").c_str(), 1);
  }

  ChildResult replay(const Person& person, std::vector<std::string> arguments = {"soup.glb"}) {
    std::ofstream(folder_ / "session.json") << session_to_json(person.session());
    arguments.insert(arguments.end(), {"--replay", "session.json", "--pictures", "pictures"});
    // One sample a pixel, as the goldens and `tureen render` have.
    if (!smooth_at_rest_) arguments.emplace_back("--no-smooth-at-rest");
    return Child(arguments, folder_).wait();
  }
  Image8 image(const std::string& name) const {
    Input input = Input::open(folder_ / "pictures" / (name + ".png"));
    return read_image(input);
  }
  /// The image of `tureen render` with these options.
  Image8 rendered(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"render", "soup.glb"});
    arguments.insert(arguments.end(), {"-o", "rendered.png", "--force"});
    const ChildResult result = Child(arguments, folder_, TUREEN_HEADLESS_PROGRAM).wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    Input input = Input::open(folder_ / "rendered.png");
    return read_image(input);
  }

  /// A dataset of one training and one test photograph, both drawn from the scene itself.
  void write_photographs() const {
    const Scene scene = read_scene(folder_ / "soup.glb");
    fs::create_directories(folder_ / "photographs");
    for (const auto& [split, index] : {std::pair("train", 0), std::pair("test", 40)}) {
      const Camera camera = resized(scene.cameras.at(std::size_t(index)), 240, 200);
      const Image8 drawn =
          rendered({"--camera", "soup.glb:" + std::to_string(index), "--size", "240x200"});
      fs::copy(folder_ / "rendered.png", folder_ / "photographs" / (std::string(split) + ".png"));
      const glm::dmat4 pose = glm::inverse(camera.view_from_world);
      nlohmann::json matrix = nlohmann::json::array();
      for (int row = 0; row < 4; ++row)
        matrix.push_back({pose[0][row], pose[1][row], pose[2][row], pose[3][row]});
      std::ofstream(folder_ / "photographs" / ("transforms_" + std::string(split) + ".json"))
          << nlohmann::json{
                 {"fl_x", camera.fx},
                 {"fl_y", camera.fy},
                 {"cx", camera.cx},
                 {"cy", camera.cy},
                 {"w", 240},
                 {"h", 200},
                 {"frames",
                  {{{"file_path", std::string(split) + ".png"}, {"transform_matrix", matrix}}}}};
    }
  }

  fs::path folder_;
  bool smooth_at_rest_ = false;
};

/// Slow tests of features that change rarely: only in `./dev test --all`.
class ThoroughWindow : public Window {};

inline void expect_equal(const Image8& a, const Image8& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  std::size_t off = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) off += a.pixels[i] != b.pixels[i];
  EXPECT_EQ(off, 0u) << "pixels of " << a.pixels.size();
}

}  // namespace window_test
}  // namespace tureen::test
