#include "scene/document/history.hpp"

#include <algorithm>

namespace tureen {

void History::perform(Document& document, const Edit& edit, std::uint64_t gesture) {
  std::string name = describe(edit, document);
  Edit undo = apply_edit(document, edit);
  steps_.resize(position_);
  if (gesture != 0 && !steps_.empty() && steps_.back().gesture == gesture &&
      sets_the_same(steps_.back().edit, edit)) {
    steps_.back().serial = ++last_serial_;  // it leads to another state
    return;
  }
  steps_.push_back({std::move(name), std::move(undo), ++last_serial_, gesture});
  ++position_;
  drop_beyond_limit();
}

void History::go_to(Document& document, std::size_t position) {
  position = std::min(position, steps_.size());
  while (position_ != position) {
    Step& step = steps_[position_ < position ? position_ : position_ - 1];
    step.edit = apply_edit(document, step.edit);
    step.gesture = 0;  // what follows is another gesture
    position_ < position ? ++position_ : --position_;
  }
  drop_beyond_limit();
}

void History::replace_primitives(const DocumentLayer& read) {
  for (Step& step : steps_)
    if (auto* added = std::get_if<AddLayers>(&step.edit))
      for (AddLayers::Added& each : added->layers)
        if (each.layer.id == read.id) {
          each.layer.primitives = read.primitives;
          each.layer.bounds = read.bounds;
        }
  drop_beyond_limit();
}

std::size_t History::kept_bytes() const {
  // Each layer is either in the document or in one step.
  std::size_t bytes = 0;
  for (const Step& step : steps_) bytes += byte_size(step.edit);
  return bytes;
}

void History::drop_beyond_limit() {
  while (kept_bytes() > max_bytes_) {
    const auto done = steps_.begin() + std::ptrdiff_t(position_);
    const auto holder = std::find_if(steps_.begin(), done,
                                     [](const Step& step) { return byte_size(step.edit) > 0; });
    if (holder == done) {  // undone steps hold the bytes
      steps_.pop_back();
      continue;
    }
    oldest_ = holder->serial;
    position_ -= std::size_t(holder - steps_.begin()) + 1;
    steps_.erase(steps_.begin(), holder + 1);
  }
}

}  // namespace tureen
