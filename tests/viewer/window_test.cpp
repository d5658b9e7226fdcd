// The window, as a person uses it: sessions replayed under an X server that draws into memory. The
// window is compared with goldens, and its images with `tureen render`. The file exceeds 600 lines:
// its sessions share scenes and helpers; those of the panel and of photographs have files of their
// own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/matrix.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include "base/input.hpp"
#include "formats/scene_file.hpp"
#include "image/metrics.hpp"
#include "image/png.hpp"
#include "tests/cli/child.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/golden.hpp"
#include "tests/viewer/display.hpp"
#include "tests/viewer/window_fixture.hpp"
#include "trainer/common/run_control.hpp"
#include "trainer/common/training_log.hpp"
#include "viewer/files/session.hpp"
#include "viewer/messages.hpp"

namespace tureen::test {
namespace window_test {

/// One server for all tests in this process.
class DisplayEnvironment : public testing::Environment {
 public:
  void SetUp() override { display_ = std::make_unique<Display>(); }
  void TearDown() override { display_.reset(); }

 private:
  std::unique_ptr<Display> display_;
};
[[maybe_unused]] const auto* const environment =
    testing::AddGlobalTestEnvironment(new DisplayEnvironment);  // GoogleTest owns it

TEST_F(Window, ShowsTheSceneAndItsPanels) {
  const ChildResult result = replay(Person().look("loaded"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_golden(image("loaded"), "window_loaded");
}

TEST_F(Window, OrbitsFliesAndSwitchesViews) {
  const ChildResult result = replay(Person()
                                        .wait()
                                        .press(Key::digit_7)
                                        .drag(Button::left, {150, 200}, {230, 180})
                                        .turn_wheel(2)
                                        .drag(Button::right, {150, 200}, {160, 230})
                                        .look("orbited")
                                        .hold(Key::w, 0.4)
                                        .hold(Key::d, 0.2)
                                        .drag(Button::left, {150, 200}, {130, 210})
                                        .look("flown"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_golden(image("orbited"), "window_orbited");
  expect_golden(image("flown"), "window_flown");
}

TEST_F(Window, ABadFileShowsItsErrorAndTheOldSceneStays) {
  std::ofstream(folder_ / "bad.glb") << "glTF, it says";
  const ChildResult result = replay(Person().wait().drop("bad.glb").look("bad"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, Names("bad.glb"));
  expect_golden(image("bad"), "window_bad_file");
}

TEST_F(Window, AnErrorAboutOpeningEndsWhenTheNextSceneOpens) {
  std::ofstream(folder_ / "bad.glb") << "glTF, it says";
  write_square(folder_ / "floor.off", "255 0 0");
  const ChildResult result =
      replay(Person().wait().drop("bad.glb").wait().drop("floor.off").wait());
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(Window, ADamagedLargeFileIsShownInPart) {
  // 2^19 records of 32 bytes, and a byte too many: small white splats in the plane z = 0.
  std::string record(32, '\xff');
  std::ofstream file(folder_ / "large.splat", std::ios::binary);
  for (int i = 0; i < 1 << 19; ++i) {
    const float values[6] = {float(i % 64), float(i / 64 % 64), 0, 0.3f, 0.3f, 0.3f};
    std::memcpy(record.data(), values, sizeof values);
    file << record;
  }
  file << '!';
  file.close();
  const ChildResult result = replay(Person().wait().press(Key::h).look("part"), {"large.splat"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, Names("large.splat is shown only in part"));
  const Image8 part = image("part");
  EXPECT_NE(part.pixels[part.pixels.size() / 2 + std::size_t(part.width) / 2], part.pixels[0]);
}

TEST_F(Window, WithoutASceneAsksForOne) {
  const ChildResult result = replay(Person().look("empty").press(Key::f1).look("keys"), {});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_golden(image("empty"), "window_empty");
  expect_golden(image("keys"), "window_keys");
}

TEST_F(Window, OpensTheExample) {
  const ChildResult result = replay(Person().wait().click("Open the example").look("example"), {});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(replay(Person().look("loaded"), {"soup.glb"}).exit_code, 0);
  // The panels differ: the name of the file.
  const Image8 example = image("example"), loaded = image("loaded");
  for (const glm::ivec2 at : {glm::ivec2(180, 200), glm::ivec2(100, 250), glm::ivec2(250, 150)}) {
    const std::size_t index = std::size_t(at.y) * std::size_t(example.width) + std::size_t(at.x);
    EXPECT_EQ(example.pixels[index], loaded.pixels[index]);
  }
}

TEST_F(Window, HasALightTheme) {
  const ChildResult result =
      replay(Person().wait().press(Key::digit_7).press(Key::t).look("light"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_golden(image("light"), "window_light");
}

// Without panels, the window shows exactly the pixels of `tureen render`.
TEST_F(Window, ShowsTheImageOfTureenRender) {
  const ChildResult result = replay(Person({640, 400})
                                        .wait()
                                        .press(Key::h)
                                        .press(Key::right_bracket)
                                        .press(Key::right_bracket)
                                        .look("second"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_equal(image("second"), rendered({"--camera", "soup.glb:1", "--size", "640x400"}));
}

TEST_F(Window, SavesImagesUnderNewNames) {
  const ChildResult result = replay(Person({640, 400})
                                        .wait()
                                        .press(Key::h)
                                        .press(Key::right_bracket)
                                        .wait()  // until the view is there
                                        .press(Key::p)
                                        .wait()
                                        .press_with_control(Key::s, Key::shift)
                                        .wait());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Image8 expected = rendered({"--camera", "soup.glb:0", "--size", "640x400"});
  expect_equal(image("soup-1"), expected);
  expect_equal(image("soup-2"), expected);
}

/// Shows the panel Image.
Person& open_images(Person& person) {
  return person.wait().click("tab: Camera").click("section: View");
}

TEST_F(ThoroughWindow, SavesImagesLargerThanItself) {
  Person person({720, 640});
  open_images(person.wait().press(Key::right_bracket));
  person.click("Size").click("3840 \u00d7 2160").point({200, 300}).look("panel");
  const ChildResult result = replay(person.press(Key::p).wait());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_golden(image("panel"), "window_images");
  expect_equal(image("soup-1"), rendered({"--camera", "soup.glb:0", "--size", "3840x2160"}));
}

TEST_F(Window, ReportsAFolderForImagesThatDoesNotExist) {
  Person person({720, 640});
  open_images(person).click("Folder");
  const Session session = person.type("no folder").press(Key::p).wait().session();
  std::ofstream(folder_ / "session.json") << session_to_json(session);
  const ChildResult result = Child({"soup.glb", "--replay", "session.json"}, folder_).wait();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, Names((folder_ / "no folder").string(), "there is no such folder"));
  EXPECT_FALSE(fs::exists(folder_ / "no folder"));
}

/// Opens the panel Image in a window of 720 x 640, and saves a page.
Person& save_page(Person& person) { return open_images(person).click("Save as a web page"); }

/// The template of a page. The program's own is missing where the page was not built.
class Template {
 public:
  explicit Template(const fs::path& file) { ::setenv("TUREEN_WEB_TEMPLATE", file.c_str(), 1); }
  ~Template() { ::unsetenv("TUREEN_WEB_TEMPLATE"); }
  Template(const Template&) = delete;
  Template& operator=(const Template&) = delete;
};

TEST_F(Window, SavesAWebPage) {
  std::ofstream(folder_ / "template.html")
      << R"(<script type="application/octet-stream;base64" id="scene" data-name=""></script>)";
  const Template other(folder_ / "template.html");
  Person person({720, 640});
  const ChildResult result = replay(save_page(person));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::ifstream file(folder_ / "pictures" / "soup-1.html");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(page, testing::HasSubstr(R"(id="scene" data-name="soup")"));
  // "glTF" in Base64, and most of the scene's bytes.
  EXPECT_THAT(page, testing::HasSubstr(">Z2xURg"));
  EXPECT_GT(page.size(), fs::file_size(folder_ / "soup.glb"));
}

TEST_F(Window, ReportsWhyAPageWasNotWritten) {
  const Template none(folder_ / "none.html");
  Person person({720, 640});
  const ChildResult result = replay(save_page(person));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, Names("soup-1.html was not written", "none.html"));
  EXPECT_FALSE(fs::exists(folder_ / "pictures" / "soup-1.html"));
}

TEST_F(ThoroughWindow, SavesAPageOfChangedLayers) {
  write_square(folder_ / "floor.off", "255 0 0");
  std::ofstream(folder_ / "template.html")
      << R"(<script type="application/octet-stream;base64" id="scene" data-name=""></script>)";
  const Template other(folder_ / "template.html");
  std::string pages[2];
  for (const bool changes : {false, true}) {
    Person person({720, 640});
    person.wait();
    if (changes) person.click("visible: floor");
    const ChildResult result = replay(save_page(person), {"soup.glb", "floor.off"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::ifstream file(folder_ / "pictures" / "soup-1.html");
    pages[changes] = {std::istreambuf_iterator<char>(file), {}};
    fs::remove(folder_ / "pictures" / "soup-1.html");
  }
  EXPECT_GT(pages[0].size(), fs::file_size(folder_ / "soup.glb"));
  EXPECT_GT(pages[1].size(), fs::file_size(folder_ / "soup.glb"));
  EXPECT_NE(pages[0], pages[1]);
}

TEST_F(Window, PlaysACameraPath) {
  Person person;
  person.wait().press(Key::digit_7).wait().press(Key::k);
  person.press(Key::digit_4).wait().press(Key::k).press(Key::space);
  person.hold(Key::super, 0.7).take("middle").look("end");
  const ChildResult result = replay(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_golden(image("middle"), "window_path_middle");
  expect_golden(image("end"), "window_path_end");
}

TEST_F(Window, ShowsDebugViews) {
  Person person;
  person.wait().press(Key::digit_7);
  const std::vector<std::string> looks = {"depth",     "normals", "triangle_id", "texels",
                                          "alpha",     "weight",  "features",    "overdraw",
                                          "wireframe", "holes"};
  for (const std::string& look : looks) person.press(Key::v).look(look);
  const ChildResult result = replay(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  // tests/runtime tests the debug views; this tests that the window displays them.
  for (std::size_t i = 1; i < looks.size(); ++i)
    EXPECT_NE(image(looks[i]).pixels, image(looks[i - 1]).pixels) << looks[i];
  expect_golden(image("depth"), "window_depth");
}

TEST_F(ThoroughWindow, BackFromADebugViewTheColoursAreCurrent) {
  const auto drag = [](Person& person) -> Person& {
    return person.drag(Button::left, {150, 200}, {230, 180}).wait();
  };
  Person plain, looked;
  drag(plain.wait().press(Key::digit_7).wait()).look("plain");
  looked.wait().press(Key::digit_7).wait().press(Key::v).wait();
  drag(looked);
  for (int i = 0; i < 11; ++i) looked.press(Key::v);  // once around, back to the colours
  looked.look("back");
  EXPECT_EQ(replay(plain).exit_code, 0);
  const ChildResult result = replay(looked);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_equal(image("back"), image("plain"));
}

TEST_F(Window, AnotherSceneIsShownAsFarAsItCanBe) {
  std::ofstream(folder_ / "plain.off") << "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 9 9 9\n";
  Person person;
  person.wait();
  for (int i = 0; i < 4; ++i) person.press(Key::v).wait();  // texels, which plain.off does not have
  const ChildResult result = replay(person.drop("plain.off").wait().press(Key::v).look("other"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

// The saved image is the displayed one, although another renderer than the window's draws it.
TEST_F(Window, SavesTheDebugView) {
  const ChildResult result = replay(Person({320, 240})
                                        .wait()
                                        .press(Key::h)
                                        .press(Key::right_bracket)
                                        .press(Key::v)
                                        .look("shown")
                                        .press(Key::p)
                                        .wait());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Image8 saved = image("soup-1");
  expect_equal(saved, rendered({"--camera", "soup.glb:0", "--size", "320x240", "--show", "depth"}));
  expect_equal(image("shown"), saved);
}

TEST_F(Window, ImagesInARowAreAllSaved) {
  Person person({320, 200});
  person.wait().press(Key::h);
  for (int i = 0; i < 3; ++i) person.press(Key::p);
  EXPECT_EQ(replay(person.wait()).exit_code, 0);
  for (const char* name : {"soup-1", "soup-2", "soup-3"}) EXPECT_EQ(image(name).width, 320);
}

TEST_F(Window, FilesCanBePickedBeforeThereIsAScene) {
  EXPECT_EQ(replay(Person().look("empty").press_with_control(Key::o).look("files"), {}).exit_code,
            0);
  EXPECT_NE(image("empty").pixels, image("files").pixels);
}

// The photographs are drawn from the scene itself: the difference must be zero.
TEST_F(Window, ComparesWithThePhotographs) {
  write_photographs();
  const ChildResult result = replay(Person()
                                        .wait()
                                        .press(Key::left_bracket)
                                        .press(Key::c)
                                        .look("split")
                                        .press(Key::c)
                                        .press(Key::c)
                                        .look("difference"),
                                    {"soup.glb", "photographs"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_golden(image("split"), "window_split");
  expect_golden(image("difference"), "window_difference");
}

TEST_F(ThoroughWindow, ReportsThatNoPhotographHasTheView) {
  write_photographs();
  Person person;
  person.wait().without_notes().look("off").press(Key::c).look("split");
  EXPECT_EQ(replay(person, {"soup.glb", "photographs"}).exit_code, 0);
  EXPECT_NE(image("split").pixels, image("off").pixels);
}

TEST_F(ThoroughWindow, TheTextsOfThePanelPhotographsFit) {
  write_photographs();
  Person person({720, 640});
  person.wait().click("tab: Camera").click("section: View");
  const ChildResult result =
      replay(person.point({200, 540}).without_notes().look("panel"), {"soup.glb", "photographs"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_golden(image("panel"), "window_photographs");
}

TEST_F(Window, WorksOnEs) {
  const Person person = Person().wait().press(Key::digit_7).look("es");
  const ChildResult es = replay(person, {"soup.glb", "--api", "es"});
  EXPECT_EQ(es.exit_code, 0) << es.err;
  expect_golden(image("es"), "window_three_quarter", "es");
  const ChildResult desktop = replay(person);
  EXPECT_EQ(desktop.exit_code, 0) << desktop.err;
  expect_golden(image("es"), "window_three_quarter");
}

TEST_F(Window, FollowsItsSize) {
  const ChildResult result = replay(
      Person().wait().press(Key::h).press(Key::right_bracket).resize({500, 300}).look("small"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_equal(image("small"), rendered({"--camera", "soup.glb:0", "--size", "500x300"}));
}

TEST_F(Window, AFileThatChangesOnTheDiskIsReadAgain) {
  constexpr const char* corners = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  std::ofstream(folder_ / "scene.off") << corners << "3 0 1 2 255 0 0\n";
  std::ofstream(folder_ / "next.off") << corners << "3 0 1 2 0 0 255\n";
  const ChildResult result = replay(Person({320, 240})
                                        .wait()
                                        .press(Key::h)
                                        .without_notes()
                                        .look("before")
                                        .replace("scene.off", "next.off")
                                        .hold(Key::super, 4)  // the file is checked once a second
                                        .wait()
                                        .without_notes()
                                        .look("after"),
                                    {"scene.off"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Image8 before = image("before"), after = image("after");
  const auto count = [](const Image8& image, glm::u8vec4 color) {
    return std::count(image.pixels.begin(), image.pixels.end(), color);
  };
  const glm::u8vec4 red(255, 0, 0, 255), blue(0, 0, 255, 255);
  EXPECT_GT(count(before, red), 1000);
  EXPECT_EQ(count(before, blue), 0);
  EXPECT_EQ(count(after, red), 0);
  EXPECT_EQ(count(after, blue), count(before, red)) << "the view must not change";
}

// -- layers ---------------------------------------------------------------------------------------

std::ptrdiff_t count(const Image8& image, glm::u8vec4 color) {
  return std::count(image.pixels.begin(), image.pixels.end(), color);
}

constexpr glm::u8vec4 red(255, 0, 0, 255), blue(0, 0, 255, 255);

TEST_F(Window, ADroppedSceneIsAddedAndTheViewStays) {
  write_square(folder_ / "floor.off", "255 0 0");
  Person person;
  person.wait().press(Key::h).press(Key::right_bracket).look("before").drop("floor.off");
  person.look("added");
  const ChildResult result = replay(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(count(image("before"), red), 0);
  EXPECT_GT(count(image("added"), red), 1000);
  // The example is where it was: most of its pixels are not covered.
  const Image8 before = image("before"), added = image("added");
  std::size_t same = 0;
  for (std::size_t i = 0; i < before.pixels.size(); ++i)
    same += before.pixels[i] == added.pixels[i];
  EXPECT_GT(same, before.pixels.size() / 10);
}

TEST_F(Window, ScenesOnTheCommandLineOrDroppedTogetherAreLayersOfOneScene) {
  write_square(folder_ / "floor.off", "255 0 0");
  const auto shown = [](Person person) {
    person.wait().press(Key::h).press(Key::right_bracket);
    return person.look("shown");
  };
  EXPECT_EQ(replay(shown(Person()), {"soup.glb", "floor.off"}).exit_code, 0);
  const Image8 named = image("shown");
  EXPECT_GT(count(named, red), 1000);
  Person together, later;
  together.drop_all({"soup.glb", "floor.off"});
  EXPECT_EQ(replay(shown(together), {}).exit_code, 0);
  expect_equal(image("shown"), named);
  later.wait().drop("floor.off");
  EXPECT_EQ(replay(shown(later)).exit_code, 0);
  expect_equal(image("shown"), named);
  // The second is read together with the first, which is still loading.
  Person in_a_row;
  in_a_row.drop("soup.glb").drop("floor.off");
  EXPECT_EQ(replay(shown(in_a_row), {}).exit_code, 0);
  expect_equal(image("shown"), named);
}

TEST_F(Window, OfSeveralDroppedFilesABadOneIsNamedAndTheOthersAreAdded) {
  write_square(folder_ / "floor.off", "255 0 0");
  std::ofstream(folder_ / "bad.off") << "OFF\n1 1 0\n";
  Person person;
  person.wait().press(Key::h).press(Key::right_bracket).wait();
  const ChildResult result = replay(person.drop_all({"floor.off", "bad.off"}).look("bad"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, Names("bad.off cannot be shown"));
  EXPECT_GT(count(image("bad"), red), 1000);
}

TEST_F(Window, ATypedNameIsAFileOfTheListedFolder) {
  fs::create_directories(folder_ / "scenes");
  fs::copy(folder_ / "soup.glb", folder_ / "scenes/soup.glb");
  write_square(folder_ / "scenes/floor.off", "255 0 0");
  // A typing error keeps the dialog, and what was typed.
  Person person;
  person.wait().press(Key::o).wait().type("flor.off").look("error");
  person.press(Key::escape).look("closed").press(Key::o).wait().type("floor.off").wait();
  const ChildResult result = replay(person.look("opened"), {"scenes/soup.glb"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(image("error").pixels, image("closed").pixels);
  EXPECT_EQ(count(image("closed"), red), 0);
  EXPECT_GT(count(image("opened"), red), 1000);
}

TEST_F(Window, SavedImagesAndDebugViewsShowAllLayers) {
  write_square(folder_ / "floor.off", "255 0 0");
  Person person({320, 240});
  person.wait().press(Key::h).press(Key::right_bracket).drop("floor.off").wait();
  person.without_notes().look("colours").press(Key::p).wait().press(Key::v).wait();
  person.without_notes().look("depth").press(Key::p).wait();
  // A layer that is added to a debug view.
  person.drop("floor.off").wait().without_notes().look("depth_of_three");
  person.press(Key::p).wait();
  const ChildResult result = replay(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_equal(image("soup-1"), image("colours"));
  expect_equal(image("soup-2"), image("depth"));
  expect_equal(image("soup-3"), image("depth_of_three"));
}

/// The angle about x in the panel Layers of a scene of two layers, in a window of 720 x 720, from
/// the golden.
constexpr glm::dvec2 degrees_x{514, 588};

TEST_F(Window, ThePanelPlacesHidesAndRemovesLayers) {
  write_square(folder_ / "floor.off", "255 0 0");
  Person person({720, 720});
  person.drop_all({"soup.glb", "floor.off"}).wait().press(Key::digit_7).wait().without_notes();
  person.click("layer: floor").double_click(degrees_x).type("30").point({200, 540}).look("placed");
  // The image alone: as it is saved, as a debug view, and after the files were read again.
  person.press(Key::h).look("alone").press(Key::p).wait().press(Key::v).wait();
  person.without_notes().press(Key::p).wait().without_notes().look("depth");
  for (int i = 0; i < 8; ++i) person.press(Key::v);  // once around those that the square has
  person.press(Key::f5).wait().without_notes().look("again");
  person.press(Key::h).wait().click("visible: floor").press(Key::h).look("hidden");
  // Also in a debug view, whose passes refer to the layers.
  for (int i = 0; i < 3; ++i) person.press(Key::v);
  person.look("faces").press(Key::h).wait().click("Remove").press(Key::h).look("removed");
  const ChildResult result = replay(person, {});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_golden(image("placed"), "window_layers");
  EXPECT_GT(count(image("alone"), red), 1000);
  expect_equal(image("soup-1"), image("alone"));
  expect_equal(image("soup-2"), image("depth"));
  expect_equal(image("again"), image("alone"));
  EXPECT_EQ(count(image("hidden"), red), 0);
  expect_equal(image("removed"), image("faces"));
}

TEST_F(Window, ALayerThatArrivesDuringADragStays) {
  write_square(folder_ / "floor.off", "255 0 0");
  std::ofstream(folder_ / "wall.off")
      << "OFF\n4 2 0\n-2 0 -2\n2 0 -2\n2 0 2\n-2 0 2\n3 0 1 2 0 0 255\n3 0 2 3 0 0 255\n";
  Person person({720, 720});
  person.drop_all({"soup.glb", "floor.off"}).wait().press(Key::digit_7).wait().without_notes();
  person.click("layer: floor").begin_drag(degrees_x);
  for (int i = 1; i <= 40; ++i) {
    person.point(degrees_x + glm::dvec2(i, 0));
    if (i == 10) person.drop("wall.off");
  }
  person.end_drag().press(Key::h).look("added");
  const ChildResult result = replay(person, {});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GT(count(image("added"), blue), 1000);
}

// -- the document ---------------------------------------------------------------------------------

Person& undo(Person& person) { return person.press_with_control(Key::z).wait().without_notes(); }

TEST_F(Window, ADocumentIsChangedUndoneSavedAndReopened) {
  write_square(folder_ / "floor.off", "255 0 0");
  Person person({720, 720});
  person.wait().drop("floor.off").wait().press(Key::digit_7).wait().without_notes();
  person.look("before").begin_drag(degrees_x);
  for (int i = 1; i <= 20; ++i) person.point(degrees_x + glm::dvec2(i, 0));
  person.end_drag().point({200, 540}).look("moved").click("Remove").point({200, 540});
  person.look("removed");
  undo(person).look("moved again");
  undo(person).look("before again");  // the drag is one step
  undo(person).look("alone");
  for (int i = 0; i < 2; ++i) person.press_with_control(Key::y).wait();
  person.without_notes().press(Key::h).look("redone").press(Key::h).press_with_control(Key::s);
  person.wait().type("garden.glb").wait().without_notes().look("saved");
  ChildResult result = replay(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_golden(image("before"), "window_document");
  EXPECT_NE(image("moved").pixels, image("before").pixels);
  EXPECT_EQ(count(image("alone"), red), 0);
  // The panel differs: steps can be redone, and another layer is selected.
  const auto left = [](Image8 image) {
    for (int y = 0; y < image.height; ++y)
      for (int x = 370; x < image.width; ++x) image.pixels[std::size_t(y * image.width + x)] = {};
    return image;
  };
  expect_equal(left(image("moved again")), left(image("moved")));
  expect_equal(left(image("before again")), left(image("before")));
  Person reopened({720, 720});
  reopened.wait().press(Key::digit_7).wait().press(Key::h).without_notes().look("reopened");
  result = replay(reopened, {"garden.glb"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_equal(image("reopened"), image("redone"));
}

TEST_F(Window, AsksBeforeUnsavedChangesAreLost) {
  Person person({720, 720});
  person.wait().press(Key::i).press_with_control(Key::q).wait().without_notes().look("asked");
  person.press(Key::escape).look("open").press_with_control(Key::q).wait();
  ChildResult result = replay(Person(person).click("Discard").hold(Key::super, 1).look("end"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_golden(image("asked"), "window_unsaved");
  EXPECT_TRUE(fs::exists(folder_ / "pictures" / "open.png"));
  EXPECT_FALSE(fs::exists(folder_ / "pictures" / "end.png"));
  const glm::vec3 up = read_scene(folder_ / "soup.glb").info.up;
  result = replay(person.click("Save").hold(Key::super, 1).look("end"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(fs::exists(folder_ / "pictures" / "end.png"));
  EXPECT_EQ(read_scene(folder_ / "soup.glb").info.up, -up);
  // Nothing is left to be saved.
  Person unchanged;
  unchanged.wait().press_with_control(Key::q).hold(Key::super, 1).look("end");
  EXPECT_EQ(replay(unchanged).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "pictures" / "end.png"));
}

TEST_F(Window, ReadingAgainKeepsTheHistory) {
  write_square(folder_ / "floor.off", "255 0 0");
  write_square(folder_ / "next.off", "0 0 255");
  Person person({720, 720});
  person.wait().press(Key::digit_7).wait().click("layer: floor").click("Remove").press(Key::h);
  person.wait().without_notes().look("removed").replace("floor.off", "next.off").press(Key::f5);
  person.wait();
  // The file of the restored layer has changed meanwhile.
  undo(person).press(Key::f5).wait().without_notes().look("read");
  const ChildResult result = replay(person, {"soup.glb", "floor.off"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(count(image("removed"), red), 0);
  EXPECT_EQ(count(image("read"), red), 0);
  EXPECT_GT(count(image("read"), blue), 1000);
}

TEST_F(ThoroughWindow, EveryFileOfALayerIsWatched) {
  write_square(folder_ / "floor.off", "255 0 0");
  write_square(folder_ / "next.off", "0 0 255");
  Person person;
  person.wait().press(Key::h).press(Key::right_bracket).wait().without_notes().look("before");
  person.replace("floor.off", "next.off").hold(Key::super, 4).wait().without_notes().look("after");
  const ChildResult result = replay(person, {"soup.glb", "floor.off"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GT(count(image("before"), red), 1000);
  EXPECT_EQ(count(image("after"), blue), count(image("before"), red));
}

// -- at rest --------------------------------------------------------------------------------------

class WindowAtRest : public Window {
 protected:
  WindowAtRest() { smooth_at_rest_ = true; }

  /// PSNR in dB, at most 100.
  static double psnr(const Image8& a, const Image8& b) {
    return compare(to_float(a), to_float(b), {.with_flip = false}).psnr_db;
  }
  Image8 supersampled(const std::string& camera, const std::string& size) const {
    return rendered({"--camera", camera, "--size", size, "--supersample", "8"});
  }
  /// How often a session draws the scene.
  int drawn(const Person& person) {
    const ChildResult result = replay(person, {"soup.glb", "--report"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::size_t at = result.err.find("drawn ");
    return at == std::string::npos ? -1 : std::stoi(result.err.substr(at + 6));
  }
};

class ThoroughWindowAtRest : public WindowAtRest {};

/// docs/viewer.md gives this for the image at rest.
constexpr double min_psnr = 60;

TEST_F(WindowAtRest, ShowsAndSavesTheImageOfSupersampling) {
  Person person({640, 400});
  person.wait().press(Key::h).press(Key::right_bracket).look("first");
  // Every change begins anew.
  person.press(Key::right_bracket).look("second").press(Key::p).wait();
  const ChildResult result = replay(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GE(psnr(image("first"), supersampled("soup.glb:0", "640x400")), min_psnr);
  const Image8 second = supersampled("soup.glb:1", "640x400");
  EXPECT_GE(psnr(image("second"), second), min_psnr);
  EXPECT_GE(psnr(image("soup-1"), second), min_psnr);
  EXPECT_LT(psnr(rendered({"--camera", "soup.glb:1", "--size", "640x400"}), second), 45);
}

TEST_F(ThoroughWindowAtRest, SavesImagesOfAnyKind) {
  write_square(folder_ / "floor.off", "255 0 0");
  Person person({320, 200});
  person.wait().press(Key::h).press(Key::right_bracket).drop("floor.off").wait().without_notes();
  person.look("layers").press(Key::p).wait().press(Key::v).wait().without_notes();
  person.look("depth").press(Key::p).wait();
  const ChildResult result = replay(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GE(psnr(image("soup-1"), image("layers")), min_psnr);
  expect_equal(image("soup-2"), image("depth"));  // debug views have one sample a pixel
}

TEST_F(WindowAtRest, Ends) {
  const Person rests = Person({320, 200}).wait().press(Key::h).press(Key::right_bracket).wait();
  const int drawn_at_rest = drawn(rests);
  EXPECT_GE(drawn_at_rest, 1 + 64);
  // Time passes, and events that change nothing arrive.
  const auto later = [](Person person) { return person.hold(Key::super, 3).wait(); };
  EXPECT_EQ(drawn(later(rests)), drawn_at_rest);
  smooth_at_rest_ = false;
  EXPECT_LE(drawn(rests), drawn_at_rest - 64);
}

TEST_F(ThoroughWindowAtRest, WaitsUntilAnimationAndMotionEnd) {
  Person person({320, 200});
  person.wait().press(Key::h).press(Key::digit_7).wait().press(Key::k);
  person.press(Key::digit_4).wait().press(Key::k);
  const int before = drawn(person.wait());
  person.press(Key::space).hold(Key::super, 0.7).take("middle").wait();
  // The path lasts 1.5 s at 60 frames a second; then comes one image at rest.
  const int moving = drawn(person) - before - 64;
  EXPECT_GE(moving, 85);
  EXPECT_LE(moving, 100);
}

/// The example before a mirror, which the rasteriser draws in red.
class TracedWindow : public WindowAtRest {
 protected:
  TracedWindow() {
    smooth_at_rest_ = false;
    write_square(folder_ / "floor.off", "255 0 0");
    EXPECT_EQ(Child({"convert", "floor.off", "-o", "floor.glb", "--material", "floor=mirror"},
                    folder_, TUREEN_HEADLESS_PROGRAM)
                  .wait()
                  .exit_code,
              0);
  }
  Image8 by_rays(const std::string& camera, const std::string& samples = "1") const {
    return rendered({"floor.glb", "--camera", camera, "--size", "320x200", "--renderer", "trace",
                     "--samples", samples});
  }
  ChildResult replay_both(const Person& person, const std::string& option = "--report") {
    return replay(person, {"soup.glb", "floor.glb", option});
  }
};

TEST_F(TracedWindow, ShowsAndSavesTheImageOfRaysWhileNothingMoves) {
  Person person({320, 200});
  person.wait().press(Key::h).press(Key::right_bracket).without_notes();
  person.look("raster").press(Key::l).look("first");
  // While it moves, the rasteriser draws.
  person.press(Key::digit_7).take("moving").press(Key::right_bracket).look("second");
  person.press(Key::p).wait().without_notes().press(Key::l).look("off");
  const ChildResult result = replay_both(person);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Image8 first = by_rays("soup.glb:0"), second = by_rays("soup.glb:1");
  expect_equal(image("first"), first);
  EXPECT_GT(count(image("raster"), red), 1000);
  EXPECT_LT(count(image("first"), red), 100);
  EXPECT_GT(count(image("moving"), red), 1000);
  expect_equal(image("second"), second);
  expect_equal(image("soup-1"), second);
  EXPECT_GT(count(image("off"), red), 1000);
}

TEST_F(TracedWindow, IsSmoothAtRestAndBeginsAnewAfterAChange) {
  smooth_at_rest_ = true;
  // The camera changes while the image is drawn.
  Person person({320, 200});
  person.wait().press(Key::h).without_notes();
  person.press(Key::right_bracket).press(Key::right_bracket).look("smooth");
  const ChildResult result = replay_both(person, "--trace");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GE(psnr(image("smooth"), by_rays("soup.glb:1", "64")), min_psnr);
}

TEST_F(TracedWindow, HasTheBackgroundOfTheDocumentAndNoneOverACheckerboard) {
  Person person({720, 480});
  person.wait().press(Key::right_bracket).click("tab: Drawing").click("Background").select_all();
  person.type("4080ff").press(Key::l).press(Key::p).wait().without_notes().look("traced");
  const ChildResult result = replay_both(person.click("Checkerboard").look("over checks"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const glm::u8vec4 blue(0x40, 0x80, 0xff, 255);
  EXPECT_GT(count(image("soup-1"), blue), 1000);
  EXPECT_GT(count(image("traced"), blue), 1000);
  EXPECT_LT(count(image("traced"), red), 100);
  EXPECT_LT(count(image("over checks"), blue), 1000);
  EXPECT_GT(count(image("over checks"), red), 1000);
}

/// A run of 1,000 steps in its 250th.
void write_run(const fs::path& folder,
               trainer::PrimitiveKind kind = trainer::PrimitiveKind::triangles) {
  trainer::TrainingLog log = trainer::TrainingLog::create(folder / "run.jsonl");
  for (int step = 50; step <= 250; step += 50) {
    trainer::TrainingRecord record{.step = step,
                                   .steps = 1000,
                                   .seconds = step / 2.0,
                                   .loss = 5.0 / step,
                                   .train_psnr_db = 20 + step / 50.0,
                                   .primitives = {kind, 7000},
                                   .it_per_second = 2};
    if (step % 100 == 0) record.test_psnr_db = 19 + step / 60.0;
    log.append(record);
  }
}

TEST_F(Window, FollowsATraining) {
  write_run(folder_);
  const trainer::RunControl run(folder_ / "run.control");
  fs::copy(folder_ / "soup.glb", folder_ / "next.glb");
  Person person({720, 720});
  person.wait().press(Key::digit_7).wait().look("running");
  // The next snapshot keeps the view, without a note.
  person.replace("soup.glb", "next.glb").hold(Key::super, 4).look("again");
  person.click("Pause").point({200, 300}).look("paused");
  const std::vector<std::string> arguments{"soup.glb", "--training", "run.jsonl"};
  ChildResult result = replay(person, arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_golden(image("running"), "window_training");
  expect_equal(image("again"), image("running"));
  EXPECT_NE(image("paused").pixels, image("running").pixels);
  EXPECT_EQ(trainer::read_command(folder_ / "run.control"), trainer::RunCommand::pause);

  // The same button continues the run; the other one asks before it stops it.
  Person stopping({720, 720});
  stopping.wait().click("Continue").click("Stop and keep").look("asked");
  EXPECT_EQ(replay(stopping, arguments).exit_code, 0);
  EXPECT_EQ(trainer::read_command(folder_ / "run.control"), trainer::RunCommand::run);
  Person stopped({720, 720});
  stopped.wait().click("Stop and keep").click("Stop now");
  EXPECT_EQ(replay(stopped, arguments).exit_code, 0);
  EXPECT_EQ(trainer::read_command(folder_ / "run.control"), trainer::RunCommand::finish);
}

/// `--method triangles --opaque` begins with splats, and ends with a soup.
TEST_F(ThoroughWindow, FollowsATrainingWhoseSplatsBecomeASoup) {
  write_run(folder_, trainer::PrimitiveKind::splats);
  const float one = 1.7725f;              // a harmonic of degree 0 for a channel of 1
  const std::size_t count_of_splats = 3;  // one would let 1 % of the background through
  const Scene scene = scene_of(Splats{
      .kernel =
          Gaussians{.centers = std::vector<glm::vec3>(count_of_splats),
                    .scales = std::vector<glm::vec3>(count_of_splats, glm::vec3(0.4f)),
                    .rotations = std::vector<glm::quat>(count_of_splats, glm::quat(1, 0, 0, 0)),
                    .opacity = std::vector<float>(count_of_splats, 1.0f)},
      .color = {.degree = 0,
                .coefficients =
                    std::vector<glm::vec3>(count_of_splats, glm::vec3(one, -one, -one))},
      .profile = *profile_named("3dgs")});
  write_scene(scene, folder_ / "watched.glb");
  write_square(folder_ / "square.off", "0 0 255");
  ASSERT_EQ(Child({"convert", "square.off", "-o", "next.glb"}, folder_, TUREEN_HEADLESS_PROGRAM)
                .wait()
                .exit_code,
            0);
  Person person({720, 640});
  person.wait().press(Key::digit_7).wait().look("splats");
  person.replace("watched.glb", "next.glb").hold(Key::super, 4).look("soup");
  const ChildResult result = replay(person, {"watched.glb", "--training", "run.jsonl"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GT(count(image("splats"), red), 100);
  EXPECT_EQ(count(image("soup"), red), 0);
  EXPECT_GT(count(image("soup"), blue), 1000);
}

TEST_F(ThoroughWindow, FollowsATrainingWithoutALogOrARun) {
  const Person person = Person({720, 800}).wait().click("Pause").look("training");
  const std::vector<std::string> arguments{"soup.glb", "--training", "run.jsonl"};
  EXPECT_EQ(replay(person, arguments).exit_code, 0);
  const Image8 none = image("training");
  write_run(folder_);
  EXPECT_EQ(replay(person, arguments).exit_code, 0);
  const Image8 ended = image("training");
  EXPECT_NE(ended.pixels, none.pixels);
  std::ofstream(folder_ / "run.jsonl", std::ios::app) << "hello\n";
  EXPECT_EQ(replay(person, arguments).exit_code, 0);
  EXPECT_NE(image("training").pixels, ended.pixels);
  EXPECT_FALSE(fs::exists(folder_ / "run.control"));
}

/// A place without a control in the dialog that starts a training, in a window of 720 x 450.
constexpr glm::dvec2 words_of_dialog{360, 172};

/// While it exists, programs that a window has started become children of this process when the
/// window ends.
class LeftPrograms {
 public:
  LeftPrograms() : others_(children()) { EXPECT_EQ(::prctl(PR_SET_CHILD_SUBREAPER, 1), 0); }
  LeftPrograms(const LeftPrograms&) = delete;
  LeftPrograms& operator=(const LeftPrograms&) = delete;
  ~LeftPrograms() {
    for (const pid_t left : all()) {
      ::kill(left, SIGKILL);
      ::waitpid(left, nullptr, 0);
    }
    ::prctl(PR_SET_CHILD_SUBREAPER, 0);
  }

  /// Those that run, and those that have ended.
  std::vector<pid_t> all() const {
    std::vector<pid_t> result;
    std::ranges::set_difference(children(), others_, std::back_inserter(result));
    return result;
  }
  /// Waits for their ends, at most two minutes. Returns whether all have ended.
  bool end() const {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    for (const pid_t left : all())
      while (::waitpid(left, nullptr, WNOHANG) == 0) {
        if (std::chrono::steady_clock::now() > until) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    return true;
  }

 private:
  /// Sorted.
  static std::vector<pid_t> children() {
    std::vector<pid_t> result;
    for (const auto& entry : fs::directory_iterator("/proc")) {
      std::string line;
      std::getline(std::ifstream(entry.path() / "stat"), line);
      // The name of the program may contain spaces: the parent is the second word after it.
      const std::size_t name_end = line.rfind(") ");
      if (name_end == std::string::npos) continue;
      std::istringstream words(line.substr(name_end + 2));
      std::string state;
      pid_t parent = 0;
      if (words >> state >> parent && parent == ::getpid())
        result.push_back(std::stoi(entry.path().filename().string()));
    }
    std::ranges::sort(result);
    return result;
  }

  std::vector<pid_t> others_;
};

TEST(LeftProgram, IsFound) {
  const LeftPrograms left;
  EXPECT_TRUE(left.all().empty());
  const ChildResult shell = Child({"-c", "sleep 600 &"}, testing::TempDir(), "/bin/sh").wait();
  EXPECT_EQ(shell.exit_code, 0);
  EXPECT_EQ(left.all().size(), 1u);
}

TEST_F(Window, ATrainingStartsOnlyAfterAQuestion) {
  write_photographs();
  const LeftPrograms left;
  Person person;
  person.drop("photographs").wait().look("photographs").click("Train a scene").look("asked");
  // Outside of its field, its keys are no shortcuts; Escape closes the dialog alone.
  person.without_notes().click(words_of_dialog).look("words").press(Key::f1).press(Key::t);
  person.look("behind").press(Key::escape).look("cancelled");
  EXPECT_EQ(replay(person, {}).exit_code, 0);
  expect_equal(image("behind"), image("words"));
  EXPECT_NE(image("asked").pixels, image("photographs").pixels);
  EXPECT_TRUE(left.all().empty()) << "a training was started";
  EXPECT_FALSE(fs::exists(folder_ / "photographs.lock"));
}

TEST_F(Window, ClosedDuringItsTrainingAsksWhetherToStopIt) {
  write_photographs();
  const LeftPrograms left;
  Person person;
  person.drop("photographs").wait().click("Train a scene").press(Key::enter).wait();
  person.press_with_control(Key::q).look("asked").click("Stop the training");
  EXPECT_EQ(replay(person.hold(Key::super, 5).look("closed"), {}).exit_code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "pictures" / "asked.png"));
  EXPECT_FALSE(fs::exists(folder_ / "pictures" / "closed.png"));
  EXPECT_TRUE(left.end()) << "the training goes on";
  EXPECT_FALSE(fs::exists(folder_ / "photographs.lock"));
  EXPECT_FALSE(fs::exists(folder_ / "photographs.glb"));
}

TEST_F(Window, TheBaselineRefusesAFurtherLayer) {
  write_square(folder_ / "floor.off", "255 0 0");
  const ChildResult result =
      replay(Person().wait().drop("floor.off").wait(), {"soup.glb", "--pipeline", "baseline"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, Names("floor cannot be drawn", "baseline"));
}

TEST_F(Window, ComparesWithOneDataset) {
  for (const char* dataset : {"a", "b"}) {
    fs::create_directories(folder_ / dataset);
    std::ofstream(folder_ / dataset / "transforms.json") << "{}";
  }
  const ChildResult result = Child({"soup.glb", "a", "b"}, folder_).wait();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, Names("two datasets"));
}

TEST_F(Window, TheSameSessionShowsTheSame) {
  const Person person = Person().wait().press(Key::digit_7).hold(Key::w, 0.3).look("once");
  EXPECT_EQ(replay(person).exit_code, 0);
  const Image8 once = image("once");
  EXPECT_EQ(replay(person).exit_code, 0);
  expect_equal(once, image("once"));
}

TEST_F(Window, WhatIsRecordedCanBeReplayed) {
  const Person person = Person()
                            .wait()
                            .press(Key::digit_7)
                            .wait()
                            .drag(Button::left, {150, 200}, {230, 180})
                            .turn_wheel(2)
                            .look("end");
  EXPECT_EQ(replay(person, {"soup.glb", "--record", "recorded.json"}).exit_code, 0);
  const Image8 first = image("end");
  fs::remove(folder_ / "pictures" / "end.png");
  const ChildResult again = Child({"soup.glb", "--replay", "recorded.json", "--pictures",
                                   "pictures", "--no-smooth-at-rest"},
                                  folder_)
                                .wait();
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_GE(read_session(folder_ / "recorded.json").events.size(), 10u);
  expect_equal(image("end"), first);
}

TEST_F(Window, WhatCannotBeIsSaid) {
  ChildResult result = Child({"--size", "8"}, folder_).wait();
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, Names("--size"));
  result = Child({"--replay", "none.json"}, folder_).wait();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, Names("none.json"));
  const std::string display = std::getenv("DISPLAY");
  ::unsetenv("DISPLAY");
  result = Child({"soup.glb"}, folder_).wait();
  ::setenv("DISPLAY", display.c_str(), 1);
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.err, Names("tureen render"));
}

TEST_F(Window, ObeysTheLimitOfMemory) {
  const ChildResult refused = replay(Person().wait(), {"soup.glb", "--max-memory", "64kB"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, Names("64 KiB", "--max-memory"));
  const ChildResult read = replay(Person().wait(), {"soup.glb", "--max-memory", "1GB"});
  EXPECT_EQ(read.exit_code, 0) << read.err;
}

// `tureen view` is the same program.
TEST_F(Window, IsStartedByTureenView) {
  const ChildResult help = Child({"view", "--help"}, folder_, TUREEN_HEADLESS_PROGRAM).wait();
  EXPECT_EQ(help.exit_code, 0) << help.err;
  EXPECT_THAT(help.out, Names("tureen view"));
}

}  // namespace window_test
}  // namespace tureen::test
