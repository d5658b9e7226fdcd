// If the device is reset, the window ends with that error, and keeps the recording and the
// settings. If the device has too little memory, the window reports this and continues. The display
// is that of window_test.cpp's environment. Replaced driver functions simulate the faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.hpp"
#include "base/input.hpp"
#include "base/output.hpp"
#include "image/png.hpp"
#include "runtime/gl/api.hpp"
#include "tests/cli/child.hpp"
#include "viewer/application.hpp"

namespace tureen::viewer {
namespace lost_device_test {

namespace fs = std::filesystem;
using testing::SizeIs;
using testing::Throws;

GLenum GLAD_API_PTR tell_of_reset() { return GL_INNOCENT_CONTEXT_RESET; }

class LostDevice : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { glad_glGetGraphicsResetStatus = its_own; }

  /// Flies in a window of 480 x 320; the device is lost before the tenth frame.
  ApplicationOptions options() {
    Session session;
    session.window = {480, 320};
    for (int i = 1; i <= 100; ++i)
      session.events.push_back({0.02 * i, KeyChanged{Key::w, i % 2 == 1}});
    ApplicationOptions options;
    options.settings = folder / "viewer.json";
    options.replay = session;
    options.record = folder / "session.json";
    options.interrupted = [this] {
      if (++frames == 10) {
        its_own = glad_glGetGraphicsResetStatus;
        glad_glGetGraphicsResetStatus = tell_of_reset;
      }
      return false;
    };
    return options;
  }

  const fs::path folder = fs::path(testing::TempDir()) / "lost_device" /
                          testing::UnitTest::GetInstance()->current_test_info()->name();
  PFNGLGETGRAPHICSRESETSTATUSPROC its_own = glad_glGetGraphicsResetStatus;
  int frames = 0;
};

TEST_F(LostDevice, EndsWithItsErrorAndKeepsTheRecordingAndTheSettings) {
  Application application(options());
  EXPECT_THAT([&] { application.run(); }, Throws<ContextError>());
  EXPECT_EQ(frames, 10);
  const Session recorded = read_session(folder / "session.json");
  EXPECT_EQ(recorded.window, glm::ivec2(480, 320));
  EXPECT_GE(recorded.events.size(), 3u) << "the events before the reset";
  EXPECT_LT(recorded.events.size(), 100u);
  EXPECT_EQ(read_settings(folder / "viewer.json").window, glm::ivec2(480, 320));
}

TEST_F(LostDevice, IsToldAlsoWhereNothingCanBeKept) {
  fs::create_directory(folder / "session.json");  // the recording cannot be written
  Application application(options());
  EXPECT_THAT([&] { application.run(); }, Throws<ContextError>());
  EXPECT_EQ(read_settings(folder / "viewer.json").window, glm::ivec2(480, 320));
}

// -- Too little memory for a layer ----------------------------------------------------------------

PFNGLBUFFERDATAPROC own_buffer_data = nullptr;  // the driver's
PFNGLGETERRORPROC own_error = nullptr;
thread_local bool buffer_was_refused = false;

/// The buffer of 20,000 triangles needs 720,000 bytes; that of the example needs fewer.
constexpr GLsizeiptr max_buffer_bytes = 700000;

void GLAD_API_PTR refuse_large_buffers(GLenum target, GLsizeiptr size, const void* data,
                                       GLenum usage) {
  buffer_was_refused = target == GL_ARRAY_BUFFER && size > max_buffer_bytes;
  if (!buffer_was_refused) own_buffer_data(target, size, data, usage);
}

GLenum GLAD_API_PTR error_of_refusal() {
  return std::exchange(buffer_was_refused, false) ? GL_OUT_OF_MEMORY : own_error();
}

class FullDevice : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder);
    fs::create_directories(folder);
    write_triangles("small.off", 1);
    write_triangles("large.off", 20000);
  }
  void TearDown() override {
    if (own_buffer_data) glad_glBufferData = std::exchange(own_buffer_data, nullptr);
    if (own_error) glad_glGetError = std::exchange(own_error, nullptr);
  }

  /// Red triangles behind each other; each hides those before it only in part.
  void write_triangles(const std::string& name, int count) const {
    std::ofstream file(folder / name);
    file << "OFF\n" << count + 2 << " " << count << " 0\n-1 0 -1\n1 0 -1\n";
    for (int i = 0; i < count; ++i) file << "0 " << 1e-5 * i << " 1\n";
    for (int i = 0; i < count; ++i) file << "3 0 1 " << i + 2 << " 255 0 0\n";
  }

  /// Opens the first files, drops the others, and returns the errors shown at the end.
  std::vector<std::string> run(const std::vector<std::string>& opened,
                               const std::vector<std::string>& dropped) {
    ApplicationOptions options;
    for (const std::string& name : opened) options.scenes.push_back(folder / name);
    options.images = folder;
    Session session{.window = {480, 720}, .events = {}};  // messages are above the scene
    session.events.push_back({0.02, AwaitRest{}});
    session.events.push_back({0.04, KeyChanged{Key::h, true}});
    session.events.push_back({0.06, KeyChanged{Key::h, false}});
    FilesDropped files;
    for (const std::string& name : dropped) files.paths.push_back((folder / name).string());
    if (!dropped.empty()) session.events.push_back({0.08, files});
    session.events.push_back({0.10, AwaitRest{}});
    session.events.push_back({0.12, WindowScreenshot{"end.png"}});
    options.replay = session;
    Application application(options);
    own_buffer_data = std::exchange(glad_glBufferData, refuse_large_buffers);
    own_error = std::exchange(glad_glGetError, error_of_refusal);
    application.run();
    return application.errors();
  }

  std::ptrdiff_t red_pixels() const {
    Input input = Input::open(folder / "end.png");
    const Image8 image = read_image(input);
    return std::count(image.pixels.begin(), image.pixels.end(), glm::u8vec4(255, 0, 0, 255));
  }

  const fs::path folder = fs::path(testing::TempDir()) / "full_device" /
                          testing::UnitTest::GetInstance()->current_test_info()->name();
};

// The forecast: 20,000 triangles of 36 bytes, twice because small ones are culled on software
// OpenGL, and of 4 bytes for the colour.
const auto names_the_large_layer =
    testing::AllOf(testing::HasSubstr("The layer large does not fit"),
                   testing::ContainsRegex("Forecast: 1\\.4 MiB"));

TEST_F(FullDevice, OfDroppedLayersDrawsThoseThatFitAndNamesTheOthers) {
  EXPECT_THAT(run({"small.off"}, {"large.off", "small.off"}),
              testing::ElementsAre(names_the_large_layer));
  EXPECT_GT(red_pixels(), 500);
}

TEST_F(FullDevice, OfOpenedLayersDrawsThoseThatFitAndNamesTheOthers) {
  EXPECT_THAT(run({"large.off", "small.off"}, {}), testing::ElementsAre(names_the_large_layer));
  EXPECT_GT(red_pixels(), 500);
}

TEST_F(FullDevice, ASceneWithoutAnyLayerThatFitsIsNotShown) {
  EXPECT_THAT(run({"large.off"}, {}),
              testing::ElementsAre(testing::HasSubstr("large.off cannot be shown")));
  EXPECT_EQ(red_pixels(), 0);
}

// -- Too little memory for an image --------------------------------------------------------------

/// The longest side of a target that fits in the device's memory: enough for 400 x 300 with four
/// samples per pixel, and for 600 x 450 with one but not with four.
constexpr int max_pixels_a_side = 900;

PFNGLCHECKFRAMEBUFFERSTATUSPROC own_status = nullptr;  // the driver's

GLenum GLAD_API_PTR refuse_large_targets(GLenum target) {
  GLint texture = 0, bound = 0, width = 0, height = 0;
  glGetFramebufferAttachmentParameteriv(target, GL_COLOR_ATTACHMENT0,
                                        GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &texture);
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &bound);
  glBindTexture(GL_TEXTURE_2D, GLuint(texture));
  glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &width);
  glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &height);
  glBindTexture(GL_TEXTURE_2D, GLuint(bound));
  return std::max(width, height) > max_pixels_a_side ? GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT
                                                     : own_status(target);
}

class SmallDevice : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override {
    if (own_status) glad_glCheckFramebufferStatus = std::exchange(own_status, nullptr);
  }

  /// The example from its first camera, without panels.
  ApplicationOptions options(glm::ivec2 window) {
    ApplicationOptions options;
    options.smooth_at_rest = false;  // as `tureen render` draws
    options.scenes = {fs::path(TUREEN_SOURCE_DIR) / "examples/soup.glb"};
    options.images = folder;
    session = {.window = window, .events = {}};
    wait();
    press(Key::h);
    press(Key::right_bracket);
    return options;
  }
  void add(Event event) {
    const double before = session.events.empty() ? 0 : session.events.back().seconds;
    session.events.push_back({before + 0.02, std::move(event)});
  }
  void wait() { add(AwaitRest{}); }
  void press(Key key) {
    add(KeyChanged{key, true});
    add(KeyChanged{key, false});
  }
  /// A screenshot, once loading and motion are finished.
  void look(const std::string& name) {
    wait();
    add(WindowScreenshot{name + ".png"});
  }

  /// Runs the session on a device with this limit; returns the errors shown at its end.
  std::vector<std::string> run(ApplicationOptions options) {
    options.replay = session;
    Application application(options);
    own_status = std::exchange(glad_glCheckFramebufferStatus, refuse_large_targets);
    application.run();
    return application.errors();
  }

  /// Compares only the window's lower half: messages are in the upper half.
  void expect_same_image(const std::string& name, const std::string& expected_name) const {
    const auto lower_half = [&](const std::string& each) {
      Input input = Input::open(folder / (each + ".png"));
      const Image8 image = read_image(input);
      return std::vector(image.pixels.begin() + image.height / 2 * image.width, image.pixels.end());
    };
    const std::vector<glm::u8vec4> actual = lower_half(name), expected = lower_half(expected_name);
    ASSERT_EQ(actual.size(), expected.size());
    std::size_t off = 0, scene = 0;
    for (std::size_t i = 0; i < actual.size(); ++i) {
      off += actual[i] != expected[i];
      scene += expected[i] != expected.front();
    }
    EXPECT_EQ(off, 0u) << "pixels of " << actual.size();
    // In this view, the example fills more than a third of the half.
    EXPECT_GT(scene, actual.size() / 4) << "pixels that are not empty";
  }

  const fs::path folder = fs::path(testing::TempDir()) / "small_device" /
                          testing::UnitTest::GetInstance()->current_test_info()->name();
  Session session;
};

TEST_F(SmallDevice, DrawsOneSampleAPixelWhereMoreDoNotFit) {
  ApplicationOptions supersampled = options({400, 300});
  supersampled.drawing.quality = Quality{.supersampling = 2};
  look("small");
  add(Resized{600, 450});
  look("large");
  EXPECT_THAT(run(supersampled), SizeIs(1));
  const std::string scene = supersampled.scenes.front().string();
  const test::ChildResult plain = test::Child({"render", scene, "--camera", scene + ":0", "--size",
                                               "600x450", "-o", "plain.png"},
                                              folder, TUREEN_HEADLESS_PROGRAM)
                                      .wait();
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  expect_same_image("large", "plain");
}

TEST_F(SmallDevice, ShowsTheImageAgainInAWindowThatIsSmallAgain) {
  const ApplicationOptions resized = options({400, 300});
  look("before");
  add(Resized{1000, 500});
  wait();
  add(Resized{400, 300});
  look("after");
  EXPECT_THAT(run(resized), SizeIs(1));
  expect_same_image("after", "before");
}

TEST_F(SmallDevice, PutsAPhotographThatIsTooLargeAsideAndShowsTheImage) {
  // A photograph larger than the device's limit; it would be displayed unchanged, plain green.
  constexpr int width = 1000, height = 500;
  fs::create_directory(folder / "photographs");
  write_file(folder / "photographs/green.png",
             encode_png(Image8(width, height, glm::u8vec4(0, 255, 0, 255))));
  const nlohmann::json pose{{1, 0, 0, 0}, {0, 0, -1, -6}, {0, 1, 0, 1}, {0, 0, 0, 1}};
  const nlohmann::json frame{{"file_path", "green.png"}, {"transform_matrix", pose}};
  std::ofstream(folder / "photographs/transforms.json") << nlohmann::json{
      {"fl_x", width}, {"fl_y", width}, {"cx", width / 2},         {"cy", height / 2},
      {"w", width},    {"h", height},   {"frames", {frame, frame}}};
  ApplicationOptions compared = options({600, 450});
  compared.dataset = folder / "photographs";
  look("before");
  press(Key::c);
  look("after");
  EXPECT_THAT(run(compared), SizeIs(1));
  expect_same_image("after", "before");
}

}  // namespace lost_device_test
}  // namespace tureen::viewer
