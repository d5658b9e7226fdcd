// The steps of a document's user: undo and redo. A moved view is no step, and neither are files
// that are read again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/document/edit.hpp"

namespace tureen {

class History {
 public:
  static constexpr std::size_t default_max_bytes = std::size_t(1) << 30;

  /// `max_bytes`: limit for the primitives of layers that only the history keeps, such as removed
  /// ones. Beyond it, the oldest steps are dropped first.
  explicit History(std::size_t max_bytes = default_max_bytes) : max_bytes_(max_bytes) {}

  struct Step {
    std::string name;  // "Move house"
    /// What undoes the step, or, after position(), what repeats it.
    Edit edit;
    std::uint64_t serial = 0;   // no two steps have the same
    std::uint64_t gesture = 0;  // that of perform()
  };

  /// Applies an edit as a new step, and drops the steps that could be redone. Edits of one gesture
  /// that set the same thing, such as those of a drag, are one step. `gesture`: a number that no
  /// other gesture has, or 0 for none.
  void perform(Document& document, const Edit& edit, std::uint64_t gesture = 0);

  /// The oldest step comes first; those before position() are done, the others are undone.
  const std::vector<Step>& steps() const { return steps_; }
  std::size_t position() const { return position_; }
  /// Undoes or redoes steps until position() is this. Beyond the last step: redoes all.
  void go_to(Document& document, std::size_t position);
  void undo(Document& document) { go_to(document, position_ > 0 ? position_ - 1 : 0); }
  void redo(Document& document) { go_to(document, position_ + 1); }

  /// Identifies the document's state: equal for equal states, whatever is dropped or undone.
  std::uint64_t state() const { return position_ > 0 ? steps_[position_ - 1].serial : oldest_; }
  /// Notes that a file has this state().
  void mark_saved(std::uint64_t state) { saved_ = state; }
  bool is_saved() const { return saved_ == state(); }

  /// A file was read again: replaces the primitives of this layer in all steps.
  void replace_primitives(const DocumentLayer& read);

  std::size_t kept_bytes() const;

 private:
  void drop_beyond_limit();

  std::size_t max_bytes_;
  std::vector<Step> steps_;
  std::size_t position_ = 0;
  std::uint64_t last_serial_ = 0;
  std::uint64_t oldest_ = 0;  // state() before the first step
  std::uint64_t saved_ = 0;
};

}  // namespace tureen
