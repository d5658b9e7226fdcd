// The messages of the window: notes and errors. Notes disappear after note_seconds, errors stay
// until dismissed, those about opening until the next file is opened, those about the shown scene
// also until its files are read again.
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
  /// `opening`: a file that was to be opened. `scene`: a file or a layer of the shown scene.
  enum class About { other, opening, scene };
  About about = About::other;
};

class Messages {
 public:
  /// Seconds that a note stays.
  static constexpr double note_seconds = 6;
  static constexpr std::size_t most = 5;  // messages; drops the oldest note first

  /// All pass texts, which may come from files, through shown_line (base/shown_text.hpp).
  void note(const std::string& text, double now);
  void error(const std::string& title, const std::string& reason, double now,
             Message::About about = Message::About::other);
  void dismiss(std::size_t index);
  /// Removes the errors about opening and about the scene, when another file was opened.
  void dismiss_opening();
  /// Removes the errors about the scene, when its files were read again.
  void dismiss_scene();
  /// Removes notes older than note_seconds.
  void age(double now);
  const std::vector<Message>& list() const { return list_; }
  bool fading() const;  // whether there are notes that age() will remove

 private:
  void add(Message message);
  std::vector<Message> list_;
};

}  // namespace tureen::viewer
