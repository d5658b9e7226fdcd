// Events of the window as plain values. Sessions can be recorded, edited by hand and replayed
// (viewer/files/session.hpp), and tests can simulate a user.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tureen::viewer {

/// Keys that the window or its text fields use. Letters and digits are positions on an American
/// keyboard, whatever their labels.
enum class Key {
  // clang-format off
  a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u, v, w, x, y, z,
  digit_0, digit_1, digit_2, digit_3, digit_4, digit_5, digit_6, digit_7, digit_8, digit_9,
  f1, f2, f3, f4, f5, f6, f7, f8, f9, f10, f11, f12,
  left, right, up, down, home, end, page_up, page_down, insert, del,
  left_bracket, right_bracket, minus, equal, comma, period, slash,
  tab, backspace, enter, escape, space, shift, control, alt, super,
  // clang-format on
};
inline constexpr int key_count = static_cast<int>(Key::super) + 1;

/// The name in the list of keys and in session files: "W", "F1", "[", "Home".
std::string_view name_of(Key key);
std::optional<Key> key_named(std::string_view name);

enum class Button { left, right, middle };

/// In points of the window from its upper left corner. A point is a pixel, except on high-DPI
/// screens.
struct PointerMoved {
  double x = 0, y = 0;
};
struct ButtonChanged {
  Button button = Button::left;
  bool down = false;
};
/// Steps of the wheel: to the right, and away from the user.
struct Scrolled {
  double right = 0, away = 0;
};
struct KeyChanged {
  Key key = Key::a;
  bool down = false;
};
struct TextTyped {
  std::uint32_t code_point = 0;
};
struct FilesDropped {
  std::vector<std::string> paths;
};
/// In points.
struct Resized {
  int width = 0, height = 0;
};
struct FocusChanged {
  bool focused = false;
};
struct CloseAsked {};

/// Only in sessions: later events wait until nothing is being loaded and nothing moves.
struct AwaitRest {};
/// Only in sessions: saves the window with its interface as a PNG of this name in the program's
/// folder for images.
struct WindowScreenshot {
  std::string name;
};

/// Only in sessions: a click on the control with this name, wherever it is: the label of a button,
/// switch, field or choice, "tab: Drawing", "section: Image", "layer: house", "gizmo: x".
struct ControlClicked {
  std::string name;
  PointerMoved by = {};  // a drag over this distance, if it is not 0
};

/// Only in sessions: copies one file over another, as another program does.
struct FileReplaced {
  std::string from, to;
};

using Event = std::variant<PointerMoved, ButtonChanged, Scrolled, KeyChanged, TextTyped,
                           FilesDropped, Resized, FocusChanged, CloseAsked, AwaitRest, FileReplaced,
                           WindowScreenshot, ControlClicked>;

struct TimedEvent {
  double seconds = 0;  // since the session began
  Event event;
};

}  // namespace tureen::viewer
