// Saves the scene, and asks before unsaved changes are lost.
#include <system_error>
#include <utility>

#include "viewer/application.hpp"
#include "viewer/names.hpp"
#include "viewer/scene/saving.hpp"

namespace tureen::viewer {

namespace fs = std::filesystem;

bool Application::asks_before(const Leave& leave) {
  if (!state_.stage || state_.history.is_saved()) return false;
  state_.saving = {};
  state_.saving.leaving = leave;
  return true;
}

/// The file that Ctrl+S replaces; empty if the user has to name one.
fs::path Application::own_file() const {
  const SceneSource& source = state_.source;
  // A part of the scene must not replace the whole.
  if (shows_preview() || options_.max_splats || source.files.size() != 1) return {};
  return can_be_replaced(source.files.front()) ? source.path() : fs::path();
}

void Application::ask_for_name(const std::optional<Leave>& then) {
  state_.saving = {};
  if (shows_preview() || options_.max_splats)
    state_.note("The window shows only a part of the file: save it under another name.");
  const fs::path file = proposed_file(state_.source);
  state_.saving.name = {file.parent_path(), file.filename().string(), then};
}

void Application::carry_out(const SaveSceneAs&) {
  if (has_scene()) ask_for_name({});
}

void Application::carry_out(const SaveScene& request) {
  if (!has_scene()) return;
  SaveScene wish = request;
  if (wish.file.empty()) wish.file = own_file();
  if (wish.file.empty()) return ask_for_name(wish.then);
  std::error_code unknown;
  wish.file = fs::absolute(wish.file, unknown).lexically_normal();
  const auto work = [this, wish, source = state_.source, state = state_.history.state(),
                     opened = opened_](const Worker::Progress& progress) {
    progress(0);
    auto saved =
        std::make_shared<Saved>(save_scene(source, wish.file, wish.accepts_losses, progress));
    return Worker::Completion([this, wish, source, state, opened, saved] {
      if (!saved->is_written) {
        state_.saving = {};
        state_.saving.losses = {wish, saved->lost};
        return;
      }
      state_.note("Saved as " + wish.file.string() + ".");
      if (opened != opened_) return;  // another scene was opened meanwhile
      state_.history.mark_saved(state);
      adopt_file(state_.source, source, std::move(saved->file));
      shown_paths_.clear();  // the watch of the file before would report that it was written
      follow_document();
      // The job has the indices of the files before.
      if (loading_ && loading_->relation != Relation::other) load(Loading(*loading_));
      if (!wish.then) return;
      if (wish.then->opens.empty())
        state_.ask(Quit{});
      else
        state_.ask(OpenPath{wish.then->opens});
    });
  };
  const auto failed = [this, name = short_name(wish.file)](const std::string& reason) {
    state_.error(name + " was not saved", reason);
  };
  writer_.start({.kind = JobKind::writing,
                 .what = "saving " + short_name(wish.file),
                 .work = work,
                 .failed = failed});
}

}  // namespace tureen::viewer
