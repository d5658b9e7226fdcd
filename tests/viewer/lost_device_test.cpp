// A window whose device is reset: it ends with that error, and what people would miss is kept. The
// display is that of window_test.cpp's environment, the reset a function in the driver's place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "runtime/gl/api.hpp"
#include "soup/error.hpp"
#include "viewer/application.hpp"

namespace tureen::viewer {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

GLenum GLAD_API_PTR tell_of_reset() { return GL_INNOCENT_CONTEXT_RESET; }

class LostDevice : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { glad_glGetGraphicsResetStatus = its_own; }

  /// Flies through a window of 480 x 320; the device is lost before the tenth frame.
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
  EXPECT_THAT([&] { application.run(); },
              ThrowsMessage<ContextError>(HasSubstr("the graphics device was reset")));
  EXPECT_EQ(frames, 10);
  const Session recorded = read_session(folder / "session.json");
  EXPECT_EQ(recorded.window, glm::ivec2(480, 320));
  EXPECT_GE(recorded.events.size(), 3u) << "what happened until then";
  EXPECT_LT(recorded.events.size(), 100u);
  EXPECT_EQ(read_settings(folder / "viewer.json").window, glm::ivec2(480, 320));
}

TEST_F(LostDevice, IsToldAlsoWhereNothingCanBeKept) {
  fs::create_directory(folder / "session.json");  // in the recording's place
  Application application(options());
  EXPECT_THAT([&] { application.run(); },
              ThrowsMessage<ContextError>(HasSubstr("the graphics device was reset")));
  EXPECT_EQ(read_settings(folder / "viewer.json").window, glm::ivec2(480, 320));
}

}  // namespace
}  // namespace tureen::viewer
