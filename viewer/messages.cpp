#include "viewer/messages.hpp"

#include <algorithm>
#include <utility>

#include "base/shown_text.hpp"

namespace tureen::viewer {

void Messages::note(const std::string& text, double now) {
  add({Message::Kind::note, "", shown_line(text), now});
}

void Messages::error(const std::string& title, const std::string& reason, double now,
                     Message::About about) {
  add({Message::Kind::error, shown_line(title), shown_line(reason), now, about});
}

void Messages::add(Message message) {
  // A repeated message replaces the old one.
  std::erase_if(list_, [&](const Message& other) {
    return other.kind == message.kind && other.title == message.title && other.text == message.text;
  });
  list_.push_back(std::move(message));
  if (list_.size() <= most) return;
  // Drops the oldest note first, otherwise the oldest error.
  const auto note = std::find_if(list_.begin(), list_.end(), [](const Message& each) {
    return each.kind == Message::Kind::note;
  });
  list_.erase(note != list_.end() ? note : list_.begin());
}

void Messages::dismiss(std::size_t index) {
  list_.erase(list_.begin() + static_cast<std::ptrdiff_t>(index));
}

void Messages::dismiss_opening() {
  std::erase_if(list_,
                [](const Message& message) { return message.about != Message::About::other; });
}

void Messages::dismiss_scene() {
  std::erase_if(list_,
                [](const Message& message) { return message.about == Message::About::scene; });
}

void Messages::age(double now) {
  std::erase_if(list_, [now](const Message& message) {
    return message.kind == Message::Kind::note && now - message.since > note_seconds;
  });
}

bool Messages::fading() const {
  return std::any_of(list_.begin(), list_.end(),
                     [](const Message& message) { return message.kind == Message::Kind::note; });
}

}  // namespace tureen::viewer
