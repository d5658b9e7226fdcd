#include "viewer/input/take_frame.hpp"

#include <iterator>
#include <set>

namespace tureen::viewer {

std::vector<Event> take_frame(std::vector<Event>& pending) {
  std::set<Key> keys;
  std::set<Button> buttons;
  auto end = pending.begin();
  for (; end != pending.end(); ++end) {
    const auto* key = std::get_if<KeyChanged>(&*end);
    const auto* button = std::get_if<ButtonChanged>(&*end);
    if (key && !keys.insert(key->key).second) break;
    if (button && !buttons.insert(button->button).second) break;
    if ((button && !keys.empty()) || (key && !buttons.empty())) break;
    if (!buttons.empty() && std::holds_alternative<PointerMoved>(*end)) break;
    // The control may move until the next frame.
    if (end != pending.begin() && std::holds_alternative<ControlClicked>(*end)) break;
    if (std::holds_alternative<WindowScreenshot>(*end)) {
      ++end;
      break;
    }
  }
  std::vector<Event> result(std::make_move_iterator(pending.begin()), std::make_move_iterator(end));
  pending.erase(pending.begin(), end);
  return result;
}

}  // namespace tureen::viewer
