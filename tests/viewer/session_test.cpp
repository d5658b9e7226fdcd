// Session files: a recording can be read back; errors in a file are reported with their position.
#include "viewer/files/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "tests/support/errors.hpp"

namespace tureen::viewer {
namespace session_test {

using test::error_of;
using test::ErrorAt;
using test::ErrorIn;
using test::Refusal;

std::filesystem::path written(const std::string& text) {
  std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) /
      (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".json");
  std::ofstream(path) << text;
  return path;
}

Session read(const std::string& text) { return read_session(written(text)); }

std::optional<Refusal> refusal(const std::string& text) {
  return error_of([&] { read(text); });
}

std::string with_event(const std::string& event) {
  return R"({"tureen_session": 1, "window": [640, 480], "events": [)" + event + "]}";
}

TEST(Session, ComesBackAsItWasRecorded) {
  Session recorded{.window = {800, 600}, .events = {}};
  const std::vector<Event> first = {PointerMoved{0.1, -3}, ButtonChanged{Button::middle, true},
                                    Scrolled{0, -1}, KeyChanged{Key::left_bracket, true}};
  const std::vector<Event> second = {TextTyped{0x20ac},
                                     FilesDropped{{"a b.glb", "\"quoted\".off"}},
                                     Resized{20, 10},
                                     FocusChanged{false},
                                     AwaitRest{},
                                     WindowScreenshot{"x.png"},
                                     ControlClicked{"Save"},
                                     ControlClicked{"gizmo: x", {3, -4}},
                                     CloseAsked{}};
  recorded.add(0.1, first);
  recorded.add(1.0 / 3, second);
  const std::string text = session_to_json(recorded);
  const Session session = read(text);
  EXPECT_EQ(session.window, glm::ivec2(800, 600));
  ASSERT_EQ(session.events.size(), first.size() + second.size());
  EXPECT_EQ(session.events.back().seconds, 1.0 / 3) << "exactly equal";
  EXPECT_EQ(session_to_json(session), text);
  EXPECT_EQ(std::get<ControlClicked>(session.events[11].event).by.y, -4);
  EXPECT_EQ(std::get<FilesDropped>(session.events[5].event).paths.at(1), "\"quoted\".off");
}

TEST(Session, EveryKeyHasANameOfItsOwn) {
  for (int i = 0; i < key_count; ++i)
    EXPECT_EQ(key_named(name_of(Key(i))), std::optional(Key(i))) << name_of(Key(i));
  EXPECT_EQ(key_named("Nonsense"), std::nullopt);
}

TEST(Session, WhatIsWrongIsToldByItsPlace) {
  const std::string file = "WhatIsWrongIsToldByItsPlace.json";
  EXPECT_THAT(refusal("{"), ErrorIn(file));
  EXPECT_THAT(refusal(R"({"tureen_session": 2, "window": [1, 1], "events": []})"),
              ErrorAt(file, 1));
  EXPECT_THAT(refusal(R"({"tureen_session": 1, "window": [0, 1], "events": []})"),
              ErrorAt(file, "window"));
  EXPECT_THAT(refusal(with_event(R"({"at": 0, "key": "Wx", "down": true})")),
              ErrorAt(file, "events[0].key", "Wx"));
  EXPECT_THAT(refusal(with_event(R"({"at": 0, "dance": true})")), ErrorAt(file, "events[0]"));
  EXPECT_THAT(refusal(with_event(R"({"at": 1, "await": true}, {"at": 0.5, "await": true})")),
              ErrorAt(file, "events[1].at"));
  EXPECT_THAT(refusal(with_event(R"({"at": 0, "pointer": [1]})")),
              ErrorAt(file, "events[0].pointer"));
  EXPECT_THAT(refusal(with_event(R"({"at": 0, "button": "left"})")),
              ErrorAt(file, "events[0]", "down"));
}

TEST(Replay, DealsByItsOwnClock) {
  Replay replay(read(with_event(R"({"at": 0, "wheel": [0, 1]}, {"at": 0.05, "wheel": [0, 2]})")));
  EXPECT_EQ(replay.next(true).size(), 1u);
  int frames = 1;
  while (!replay.finished()) {
    replay.next(true);
    ++frames;
  }
  EXPECT_EQ(frames, 3) << "0.05 s are three frames of 1/60 s";
}

TEST(Replay, WaitsForRestAndEndsAFrameWithAnImage) {
  Replay replay(read(with_event(
      R"({"at": 0, "await": true}, {"at": 0, "picture": "a.png"}, {"at": 0, "wheel": [0, 1]})")));
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(replay.next(false).empty());
  EXPECT_EQ(replay.now(), 0) << "the clock stops while it waits";
  const std::vector<Event> image = replay.next(true);
  ASSERT_EQ(image.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<AwaitRest>(image[0]));
  EXPECT_TRUE(std::holds_alternative<WindowScreenshot>(image[1]));
  EXPECT_EQ(replay.next(true).size(), 1u);
  EXPECT_TRUE(replay.finished());
}

}  // namespace session_test
}  // namespace tureen::viewer
