// The progress of long work, at the bottom of the image: what, how long, and a button that cancels
// it.
#include <algorithm>

#include "base/decimal_text.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

/// Returns whether the user cancels the job.
bool job_rows(const Worker::Status& status) {
  ImGui::PushID(status.what.c_str());
  paragraph(status.what);
  if (const auto seconds = seconds_left(status)) {
    ImGui::SameLine();
    aside("\u00b7 " + duration_text(*seconds) + " left");
  }
  progress_bar(status.fraction);
  const bool cancelled = button("Cancel");
  ImGui::PopID();
  return cancelled;
}

}  // namespace

void progress_overlay(State& state) {
  const auto shown = [](const std::optional<Worker::Status>& status) {
    return status && status->seconds > progress_delay_seconds;
  };
  const bool busy = shown(state.busy) && can_be_cancelled(state.busy->kind);
  const bool writing = shown(state.writing), searching = shown(state.searching);
  if (!busy && !writing && !searching) return;
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize();
  const float width = std::min(30 * em, float(state.points.x) - 1.5f * em);
  ImGui::SetNextWindowPos({0.5f * float(state.points.x), window.y - 2.5f * em}, ImGuiCond_Always,
                          {0.5f, 1});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::Begin("progress", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
  if (writing && job_rows(*state.writing)) state.ask(StopWriting{});
  if (searching && job_rows(*state.searching)) state.ask(CancelJob{state.searching->kind});
  if (busy && job_rows(*state.busy)) state.ask(CancelJob{state.busy->kind});
  ImGui::End();
}

}  // namespace tureen::viewer
