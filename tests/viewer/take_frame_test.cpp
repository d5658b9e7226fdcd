// What a user does during one long frame reaches the interface in the order in which it was done.
#include "viewer/input/take_frame.hpp"

#include <gtest/gtest.h>

namespace tureen::viewer {
namespace take_frame_test {

/// What Dear ImGui reads in a frame: the last place of the pointer, and whether the button is down.
struct Seen {
  double x = 0;
  bool down = false;
  bool operator==(const Seen&) const = default;
};

std::vector<Seen> frames(std::vector<Event> pending) {
  std::vector<Seen> result;
  Seen state;
  while (!pending.empty()) {
    for (const Event& event : take_frame(pending)) {
      if (const auto* moved = std::get_if<PointerMoved>(&event)) state.x = moved->x;
      if (const auto* button = std::get_if<ButtonChanged>(&event)) state.down = button->down;
    }
    result.push_back(state);
  }
  return result;
}

TEST(TakeFrame, TwoClicksInOneFrameStayAtTheirPlaces) {
  const std::vector<Event> events{PointerMoved{10, 0},
                                  ButtonChanged{Button::left, true},
                                  ButtonChanged{Button::left, false},
                                  PointerMoved{15, 0},
                                  PointerMoved{20, 0},
                                  ButtonChanged{Button::left, true},
                                  ButtonChanged{Button::left, false}};
  EXPECT_EQ(frames(events), (std::vector<Seen>{{10, true}, {10, false}, {20, true}, {20, false}}));
}

TEST(TakeFrame, ADragBeginsWhereTheButtonWasPressed) {
  const std::vector<Event> events{
      PointerMoved{10, 0}, ButtonChanged{Button::left, true},  PointerMoved{12, 0},
      PointerMoved{30, 0}, ButtonChanged{Button::left, false}, PointerMoved{50, 0}};
  EXPECT_EQ(frames(events), (std::vector<Seen>{{10, true}, {30, false}, {50, false}}));
}

TEST(TakeFrame, AClickWaitsForWhatAKeyOpens) {
  std::vector<Event> events{KeyChanged{Key::o, true}, KeyChanged{Key::o, false}, PointerMoved{1, 0},
                            ButtonChanged{Button::left, true}};
  EXPECT_EQ(take_frame(events).size(), 1u);
  EXPECT_EQ(take_frame(events).size(), 2u);
  EXPECT_EQ(take_frame(events).size(), 1u);
}

TEST(TakeFrame, ADragEndsBeforeItsKeyIsReleased) {
  std::vector<Event> events{ButtonChanged{Button::left, false}, KeyChanged{Key::control, false}};
  EXPECT_EQ(take_frame(events).size(), 1u);
}

TEST(TakeFrame, MovesWithoutAButtonAreOneFrame) {
  std::vector<Event> events{PointerMoved{1, 0}, PointerMoved{2, 0}, Scrolled{0, 1}};
  EXPECT_EQ(take_frame(events).size(), 3u);
  EXPECT_TRUE(events.empty());
}

}  // namespace take_frame_test
}  // namespace tureen::viewer
