// What the window has to say: things done, and things that went wrong. Notes fade after a while,
// errors stay until they are dismissed.
#pragma once

#include <string>
#include <vector>

namespace tureen::viewer {

struct Message {
  enum class Kind { note, error };
  Kind kind = Kind::note;
  std::string title;  // "bad.glb cannot be shown"
  std::string text;   // the reason
  double since = 0;   // seconds of the window's clock
};

class Messages {
 public:
  /// How long a note stays.
  static constexpr double note_seconds = 6;
  static constexpr std::size_t most = 5;  // of which the newest stay

  /// Texts may come from files: shown_line (base/shown_text.hpp).
  void note(const std::string& text, double now);
  void error(const std::string& title, const std::string& reason, double now);
  void dismiss(std::size_t index);
  /// Takes away the notes that have been seen.
  void age(double now);
  const std::vector<Message>& list() const { return list_; }
  bool fading() const;  // whether age() will have something to do

 private:
  void add(Message message);
  std::vector<Message> list_;
};

}  // namespace tureen::viewer
