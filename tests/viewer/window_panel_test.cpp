// The panel and what it changes in the image: tabs, gizmo, background, first view, flights.
#include <gmock/gmock.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "formats/dataset/camera_file.hpp"
#include "image/metrics.hpp"
#include "scene/similarity.hpp"
#include "tests/formats/splat/sog_fixture.hpp"
#include "tests/support/golden.hpp"
#include "tests/viewer/window_fixture.hpp"

namespace tureen::test {
namespace window_test {

class WindowPanel : public Window {
 protected:
  /// The place of the only layer in the file that a session saved.
  glm::dmat4 saved_place(const std::string& file) const {
    return read_scene(folder_ / file).layers.at(0).world_from_layer;
  }
};

/// Clicking a control that is scrolled out of sight ends the program with an error.
TEST_F(WindowPanel, FitsASmallScreen) {
  Person person({1280, 720});
  person.wait();
  for (const char* control : {"Steps", "layer: soup", "gizmo: Move", "gizmo: Off", "Rotation",
                              "Scale", "Set on the ground", "Center", "Reset"})
    person.click(control).press(Key::escape);
  // The second click closes a list.
  person.point({200, 600}).look("scene").click("tab: Drawing");
  for (const char* control :
       {"View", "View", "Background", "Resolution", "Resolution", "theme: Light", "theme: Dark"})
    person.click(control).press(Key::escape);
  person.point({200, 600}).look("drawing").click("tab: Camera");
  for (const char* control :
       {"mode: Orbit", "Corner", "Frame all", "First view", "Keep as first view", "Up", "Up",
        "section: Camera path", "section: Camera path"})
    person.click(control).press(Key::escape);
  const ChildResult result = replay(person.point({200, 600}).without_notes().look("camera"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* tab : {"drawing", "camera"})
    expect_golden(image(tab), std::string("window_") + tab);
}

TEST_F(WindowPanel, AnUnknownControlIsAnError) {
  const ChildResult result = replay(Person().wait().click("Fly to the moon"));
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, testing::HasSubstr("Fly to the moon"));
}

TEST_F(WindowPanel, TheGizmoMovesALayer) {
  const glm::dmat4 before = saved_place("soup.glb");
  Person person({1000, 700});
  person.wait().press(Key::digit_1).wait().press(Key::g).look("move");
  // From the front, the arrow of x goes to the right.
  person.drag_control("gizmo: x", {60, 0}).wait().look("moved");
  person.press_with_control(Key::s).wait().press_with_control(Key::z).wait();
  person.without_notes().look("undone");
  const ChildResult result = replay(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_golden(image("move"), "window_gizmo");
  const glm::dvec3 way(saved_place("soup.glb")[3] - before[3]);
  EXPECT_GT(way.x, 0.1);
  EXPECT_LT(glm::length(glm::dvec2(way.y, way.z)), 1e-9) << "only along x";
  EXPECT_NE(image("moved").pixels, image("move").pixels);
}

TEST_F(WindowPanel, ADragOfTheGizmoIsOneStepAndSnaps) {
  const glm::dmat4 before = saved_place("soup.glb");
  Person person({1000, 700});
  person.wait().press(Key::digit_1).wait().click("gizmo: Turn").hold_control();
  // z is up: its ring lies flat, and its nearest point goes to the right.
  person.drag_control("gizmo: z", {50, 0}).wait().release_control();
  person.click("gizmo: Scale").drag_control("gizmo: size", {0, -30}).wait();
  person.press_with_control(Key::z).wait();  // only the scale is undone
  person.press_with_control(Key::s).wait();
  const ChildResult result = replay(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Similarity place = similarity_of(saved_place("soup.glb"));
  EXPECT_NEAR(place.scale, similarity_of(before).scale, 1e-9);
  const double angle = place.angles.z - similarity_of(before).angles.z;
  EXPECT_GT(std::abs(angle), 10);
  EXPECT_NEAR(angle / 15, std::round(angle / 15), 1e-6);
}

TEST_F(WindowPanel, ShowsABackgroundAndChecks) {
  Person person({640, 480});
  person.wait().click("tab: Drawing").click("Checkerboard").point({100, 300}).press(Key::h);
  const ChildResult result = replay(person.look("checks"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Image8 checks = image("checks");
  // The lower left corner is empty; checks are squares of 8 pixels.
  const auto at = [&](int x, int y) {
    return checks.pixels[std::size_t((checks.height - 1 - y) * checks.width + x)];
  };
  EXPECT_NE(at(60, 60), at(68, 60));
  EXPECT_EQ(at(60, 60), at(68, 68));
  EXPECT_NE(at(60, 60), at(60, 68));
  EXPECT_EQ(at(60, 60).a, 255);
}

TEST_F(WindowPanel, KeepsAFirstViewAndTheBackgroundInTheFile) {
  Person person({1000, 700});
  person.wait().press(Key::digit_4).wait().click("tab: Camera").click("Keep as first view");
  person.click("tab: Drawing").click("Background").select_all().type("4080ff");
  person.press_with_control(Key::s).wait().press(Key::h).without_notes().look("kept");
  ChildResult result = replay(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Scene scene = read_scene(folder_ / "soup.glb");
  ASSERT_TRUE(scene.first_view);
  EXPECT_LT(glm::distance(scene.info.background, glm::vec3(0x40, 0x80, 0xff) / 255.0f), 1e-6f);
  Person again({1000, 700});
  result = replay(again.wait().press(Key::h).without_notes().look("again"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  // The file stores the view with other digits: edges may move by a fraction of a pixel.
  EXPECT_GT(
      compare(to_float(image("again")), to_float(image("kept")), {.with_flip = false}).psnr_db, 40);
}

TEST_F(WindowPanel, TakesColoursByNameAndSaysWhatItCannotRead) {
  Person person({1000, 700});
  person.wait().click("tab: Drawing").click("Background").select_all().type("wheat");
  person.press_with_control(Key::s).wait().without_notes().look("wheat");
  person.click("Background").select_all().type("whaet").look("refused");
  const ChildResult result = replay(person.press_with_control(Key::s).wait());
  EXPECT_EQ(result.exit_code, 1) << "the window shows the error at the end";
  EXPECT_THAT(result.err, testing::HasSubstr("'whaet' is not a colour"));
  EXPECT_NE(image("refused").pixels, image("wheat").pixels);
  const glm::vec3 wheat = glm::vec3(0xf5, 0xde, 0xb3) / 255.0f;
  EXPECT_LT(glm::distance(read_scene(folder_ / "soup.glb").info.background, wheat), 1e-6f);
}

TEST_F(WindowPanel, AFrameHasOneTheme) {
  Person person({1000, 700});
  person.wait().point({200, 300}).look("dark");
  person.begin_press(Key::t).take("meanwhile").at_once().end_press(Key::t).look("light");
  const ChildResult result = replay(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_equal(image("meanwhile"), image("dark"));
  EXPECT_NE(image("light").pixels, image("dark").pixels);
}

/// As the window system reports it: pointer and button come together.
TEST_F(WindowPanel, TheFirstClickOnATabCounts) {
  Person person({1000, 700});
  const glm::dvec2 tab{827, 25}, image_middle{200, 300};
  person.wait().look("scene").begin_drag(tab).at_once().end_drag().point(image_middle);
  person.look("drawing").click("tab: Drawing").point(image_middle).look("clicked");
  const ChildResult result = replay(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(image("drawing").pixels, image("scene").pixels);
  expect_equal(image("drawing"), image("clicked"));
}

TEST_F(WindowPanel, ClosesAfterTheSceneIsSaved) {
  Person person({1000, 700});
  person.wait().click("tab: Drawing").click("Background").select_all().type("wheat");
  person.press_with_control(Key::s).press_with_control(Key::q).wait().hold(Key::super, 1);
  const ChildResult result = replay(person.look("open"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(fs::exists(folder_ / "pictures/open.png")) << "the window is still open";
  const glm::vec3 wheat = glm::vec3(0xf5, 0xde, 0xb3) / 255.0f;
  EXPECT_LT(glm::distance(read_scene(folder_ / "soup.glb").info.background, wheat), 1e-6f);
}

TEST_F(WindowPanel, ReadsAnotherLevelOfAStreamedScene) {
  for (const auto& [name, content] : streamed_splats()) {
    const fs::path file = folder_ / "streamed" / name;
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << content;
  }
  const auto saved = [&](const char* file) { return splat_count(read_scene(folder_ / file)); };
  Person person({1000, 700});
  person.wait().click("Level").click("1 (coarsest)").wait().press_with_control(Key::s).wait();
  ChildResult result =
      replay(person.select_all().type("coarse.glb").press(Key::enter).wait(), {"streamed"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  Person finest;
  finest.wait().click("Level").click("0 (finest)").wait().press_with_control(Key::s).wait();
  result = replay(finest.select_all().type("fine.glb").press(Key::enter).wait(),
                  {"streamed", "--lod", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(saved("fine.glb"), 6u);
  EXPECT_EQ(saved("coarse.glb"), 4u);
  result = replay(Person().wait(), {"streamed", "--lod", "2"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, testing::HasSubstr("levels 0 to 1"));
}

TEST_F(WindowPanel, FliesAlongTheRecordedCameras) {
  Person person({1000, 700});
  person.wait().click("tab: Camera").click("section: View").click("section: Image");
  person.click("section: Camera path")
      .click_at_once("Fly along the cameras")
      .hold(Key::super, 0.3)
      .press(Key::space);
  person.wait().click("Save");
  const ChildResult result = replay(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GE(read_path(folder_ / "path.json").keyframes.size(), 4u);
}

}  // namespace window_test
}  // namespace tureen::test
