#include <array>

#include "viewer/input/event.hpp"

namespace tureen::viewer {

namespace {

constexpr std::array<std::string_view, key_count> names = {
    // clang-format off
    "A", "B", "C", "D", "E", "F", "G", "H", "I", "J", "K", "L", "M", "N", "O", "P", "Q", "R", "S",
    "T", "U", "V", "W", "X", "Y", "Z", "0", "1", "2", "3", "4", "5", "6", "7", "8", "9",
    "F1", "F2", "F3", "F4", "F5", "F6", "F7", "F8", "F9", "F10", "F11", "F12",
    "Left", "Right", "Up", "Down", "Home", "End", "PageUp", "PageDown", "Insert", "Delete",
    "[", "]", "-", "=", ",", ".", "/",
    "Tab", "Backspace", "Enter", "Escape", "Space", "Shift", "Ctrl", "Alt", "Super",
    // clang-format on
};
static_assert(!names.back().empty(), "a key has no name");

}  // namespace

std::string_view name_of(Key key) { return names[static_cast<std::size_t>(key)]; }

std::optional<Key> key_named(std::string_view name) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<Key>(i);
  return std::nullopt;
}

}  // namespace tureen::viewer
