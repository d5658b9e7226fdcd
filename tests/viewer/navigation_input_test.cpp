// The actions of drags and keys. runtime/camera_controls tests the movements.
#include "viewer/input/navigation_input.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "viewer/input/double_click.hpp"

namespace tureen::viewer {
namespace navigation_input_test {

constexpr NavigationInput::Taken nobodys{};

struct NavigationTest : testing::Test {
  NavigationTest() {
    controls.set_smoothing(0);
    controls.set_viewport(800, 600);
    send(PointerMoved{400, 300});
  }
  void send(const Event& event, NavigationInput::Taken taken = nobodys) {
    input.handle(event, taken, controls);
  }
  void drag(Button button, double dx, double dy, NavigationInput::Taken taken = nobodys) {
    send(ButtonChanged{button, true}, taken);
    send(PointerMoved{400 + dx, 300 + dy}, taken);
    send(ButtonChanged{button, false}, taken);
    send(PointerMoved{400, 300});
  }
  CameraControls controls;
  NavigationInput input;
};

TEST_F(NavigationTest, ALeftDragTurnsAboutTheTarget) {
  const glm::dvec3 eye = controls.eye(), target = controls.target();
  drag(Button::left, 50, 0);
  EXPECT_EQ(controls.target(), target);
  EXPECT_GT(glm::distance(controls.eye(), eye), 0.01);
}

TEST_F(NavigationTest, AKeyPressedWithControlDoesNotFly) {
  send(KeyChanged{Key::control, true});
  send(KeyChanged{Key::q, true});
  send(KeyChanged{Key::control, false});
  EXPECT_FALSE(input.flying());
  send(KeyChanged{Key::q, false});
  send(KeyChanged{Key::q, true});
  EXPECT_TRUE(input.flying());
}

TEST_F(NavigationTest, ARightDragAndShiftWithTheLeftMoveAlong) {
  for (const bool shift : {false, true}) {
    const glm::dvec3 target = controls.target();
    if (shift) send(KeyChanged{Key::shift, true});
    drag(shift ? Button::left : Button::right, 50, 0);
    if (shift) send(KeyChanged{Key::shift, false});
    EXPECT_GT(glm::distance(controls.target(), target), 0.01) << "shift " << shift;
  }
}

TEST_F(NavigationTest, ArrowsTurnAndWithShiftMove) {
  const glm::dvec3 eye = controls.eye(), target = controls.target();
  send(KeyChanged{Key::left, true});
  send(KeyChanged{Key::left, false});
  EXPECT_GT(glm::distance(controls.eye(), eye), 0.001);
  EXPECT_EQ(controls.target(), target);
  send(KeyChanged{Key::right, true});
  EXPECT_LT(glm::distance(controls.eye(), eye), 1e-9);
  send(KeyChanged{Key::shift, true});
  send(KeyChanged{Key::up, true});
  EXPECT_GT(glm::distance(controls.target(), target), 0.001);
}

TEST_F(NavigationTest, PlusAndMinusZoom) {
  const double distance = controls.distance();
  send(KeyChanged{Key::equal, true});
  EXPECT_LT(controls.distance(), distance);
  send(KeyChanged{Key::minus, true});
  EXPECT_NEAR(controls.distance(), distance, 1e-9 * distance);
  send(KeyChanged{Key::minus, true}, {.pointer = false, .keys = true});
  EXPECT_NEAR(controls.distance(), distance, 1e-9 * distance) << "a text field has the keys";
}

TEST(DoubleClicks, AreTwoPressesAtOnePlaceInHalfASecond) {
  struct Press {
    Button button;
    double x, now;
    bool taken;
  };
  const auto is_double = [](const Press& a, const Press& b) {
    DoubleClick clicks;
    bool result = false;
    for (const Press& press : {a, b}) {
      clicks.handle(PointerMoved{press.x, 3}, press.taken, press.now);
      result = clicks.handle(ButtonChanged{press.button, true}, press.taken, press.now);
      EXPECT_FALSE(clicks.handle(ButtonChanged{press.button, false}, press.taken, press.now));
    }
    return result;
  };
  const Press first{Button::left, 10, 1, false};
  EXPECT_TRUE(is_double(first, {Button::left, 12, 1.3, false}));
  EXPECT_FALSE(is_double(first, {Button::left, 30, 1.3, false}));
  EXPECT_FALSE(is_double(first, {Button::left, 10, 1.8, false}));
  EXPECT_FALSE(is_double(first, {Button::right, 10, 1.3, false}));
  EXPECT_FALSE(is_double(first, {Button::left, 10, 1.3, true}));
  EXPECT_FALSE(is_double({Button::left, 10, 1, true}, {Button::left, 10, 1.3, false}));
}

TEST_F(NavigationTest, ADragThatBeganOnAPanelIsThePanels) {
  const glm::dvec3 eye = controls.eye();
  drag(Button::left, 50, 0, {.pointer = true});
  EXPECT_EQ(controls.eye(), eye);
  send(Scrolled{0, 1}, {.pointer = true});
  EXPECT_EQ(controls.eye(), eye);
  EXPECT_FALSE(input.dragging());
}

TEST_F(NavigationTest, ADragThatBeganOnTheImageStaysThere) {
  const glm::dvec3 eye = controls.eye();
  send(ButtonChanged{Button::left, true});
  send(PointerMoved{500, 300}, {.pointer = true});  // now over a panel
  EXPECT_GT(glm::distance(controls.eye(), eye), 0.01);
}

TEST_F(NavigationTest, KeysFlyFasterAndSlower) {
  send(KeyChanged{Key::w, true});
  EXPECT_EQ(controls.mode(), NavigationMode::fly);
  EXPECT_EQ(input.flight().direction, glm::dvec3(0, 0, -1));
  EXPECT_EQ(input.flight().factor, 1);
  send(KeyChanged{Key::shift, true});
  EXPECT_EQ(input.flight().factor, fast_factor);
  send(KeyChanged{Key::shift, false});
  send(KeyChanged{Key::alt, true});
  EXPECT_EQ(input.flight().factor, slow_factor);
  send(KeyChanged{Key::d, true});
  EXPECT_NEAR(glm::length(input.flight().direction), 1, 1e-15) << "diagonal flight is not faster";
  send(FocusChanged{false});
  EXPECT_FALSE(input.flying()) << "keys may be released outside the window";
}

TEST_F(NavigationTest, LettersTypedIntoAFieldOrWithCtrlFlyNowhere) {
  send(KeyChanged{Key::w, true}, {.keys = true});
  EXPECT_FALSE(input.flying());
  send(KeyChanged{Key::w, false});
  send(KeyChanged{Key::control, true});
  send(KeyChanged{Key::s, true});
  EXPECT_FALSE(input.flying());
  EXPECT_EQ(controls.mode(), NavigationMode::orbit);
}

}  // namespace navigation_input_test
}  // namespace tureen::viewer
