// Camera paths: keyframes, playing, turntables, files, films.
// clang-format off: the second header wants the first
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>
// clang-format on

#include <algorithm>
#include <glm/common.hpp>
#include <optional>

#include "image/video_file.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

/// A path of hours is a mistake.
constexpr double longest = 3600;

void play_row(Film& film) {
  const double duration = film.path.duration();
  if (ImGui::Button(film.plays ? "Pause" : "Play")) film.toggle();
  tip("Space");
  ImGui::SameLine();
  auto seconds = static_cast<float>(film.seconds);
  ImGui::SetNextItemWidth(-ImGui::GetFontSize());
  if (ImGui::SliderFloat("##seconds", &seconds, 0, static_cast<float>(duration), "%.2f s",
                         ImGuiSliderFlags_AlwaysClamp))
    film.seconds = seconds;
  film.scrubbed = ImGui::IsItemActive();
}

void loop_row(Film& film) {
  bool loop = film.path.is_loop();
  if (ImGui::Checkbox("loop", &loop))
    film.path.set_loop_seconds(loop ? film.path.duration() + 1 : 0);
  if (!loop) return;
  ImGui::SameLine();
  auto seconds = static_cast<float>(film.path.data().loop_seconds);
  ImGui::SetNextItemWidth(6 * ImGui::GetFontSize());
  if (ImGui::DragFloat("seconds around", &seconds, 0.05f, 0.1f, float(longest), "%.2f",
                       ImGuiSliderFlags_AlwaysClamp))
    film.path.set_loop_seconds(seconds);
}

void keyframe_row(State& state, std::size_t index) {
  Film& film = state.film;
  const CameraKeyframe& keyframe = film.path.data().keyframes[index];
  ImGui::PushID(static_cast<int>(index));
  if (ImGui::Selectable(fmt::format("{}", index + 1).c_str(), film.selected == int(index), 0,
                        {2 * ImGui::GetFontSize(), 0})) {
    film.selected = int(index);
    film.plays = false;
    film.seconds = keyframe.seconds - film.path.begin();
    state.ask(ShowKeyframe{index});
  }
  ImGui::SameLine();
  auto seconds = static_cast<float>(keyframe.seconds);
  ImGui::SetNextItemWidth(5 * ImGui::GetFontSize());
  // Between its neighbours: past them the row would become another's.
  const auto& all = film.path.data().keyframes;
  const double earliest = index > 0 ? all[index - 1].seconds : 0;
  const double latest = index + 1 < all.size() ? all[index + 1].seconds : longest;
  std::optional<double> moved_to;
  if (ImGui::DragFloat("s", &seconds, 0.02f, float(earliest), float(latest), "%.2f",
                       ImGuiSliderFlags_AlwaysClamp))
    moved_to = std::clamp(double(seconds), earliest, latest);
  ImGui::SameLine();
  const bool replaced = ImGui::SmallButton("this view");
  tip("The keyframe becomes the view of now");
  ImGui::SameLine();
  const bool removed = ImGui::SmallButton("remove");
  ImGui::PopID();
  if (moved_to) film.path.move(index, *moved_to);
  if (replaced) film.path.replace(index, state.keyframe_of_now(keyframe.seconds));
  if (!removed) return;
  film.path.remove(index);
  film.selected = -1;
  film.seconds = std::min(film.seconds, film.path.duration());
}

void file_row(State& state) {
  Film& film = state.film;
  ImGui::SetNextItemWidth(12 * ImGui::GetFontSize());
  ImGui::InputTextWithHint("##file", "path.json", &film.file);
  ImGui::SameLine();
  {
    const Disabled disabled(film.path.empty());
    if (ImGui::Button("Save")) state.ask(SavePath{film.file.empty() ? "path.json" : film.file});
  }
  ImGui::SameLine();
  if (ImGui::Button("Load")) state.ask(LoadPath{film.file.empty() ? "path.json" : film.file});
  tip("Every tool that takes cameras takes this file: tureen render SCENE --path path.json");
}

void film_rows(State& state) {
  Film& film = state.film;
  static const bool videos = have_ffmpeg();
  int output = static_cast<int>(film.output);
  ImGui::RadioButton("PNG frames", &output, 0);
  {
    const Disabled disabled(!videos);
    ImGui::SameLine();
    ImGui::RadioButton("mp4", &output, 1);
    ImGui::SameLine();
    ImGui::RadioButton("webm", &output, 2);
  }
  if (!videos) aside(ffmpeg_missing);
  film.output = static_cast<Film::Output>(output);
  ImGui::SetNextItemWidth(9 * ImGui::GetFontSize());
  ImGui::InputInt2("pixels", &film.size.x);
  film.size = glm::clamp(film.size, 1, 8192);
  ImGui::SameLine();
  auto rate = static_cast<float>(film.frames_per_second);
  ImGui::SetNextItemWidth(4 * ImGui::GetFontSize());
  if (ImGui::DragFloat("a second", &rate, 0.1f, 1, 240, "%.0f", ImGuiSliderFlags_AlwaysClamp))
    film.frames_per_second = rate;
  if (ImGui::Button("Write the film")) state.ask(WriteFilm{});
  if (state.writing) {
    ImGui::SameLine();
    if (ImGui::Button("Stop")) state.ask(StopWriting{});
  }
}

}  // namespace

void path_panel(State& state) {
  Film& film = state.film;
  if (ImGui::Button("Add this view")) state.ask(AddKeyframe{});
  tip("K");
  ImGui::SameLine();
  if (ImGui::Button("Turntable")) state.ask(MakeTurntable{});
  tip("Once around the target from here, in so many seconds; replaces the path");
  ImGui::SameLine();
  auto seconds = static_cast<float>(film.turn_seconds);
  ImGui::SetNextItemWidth(5 * ImGui::GetFontSize());
  if (ImGui::DragFloat("s##turn", &seconds, 0.05f, 0.5f, 600, "%.1f", ImGuiSliderFlags_AlwaysClamp))
    film.turn_seconds = seconds;
  if (film.path.empty()) {
    aside("Views in a row become a smooth path: look from somewhere, add, go on.");
  } else {
    play_row(film);
    loop_row(film);
    for (std::size_t i = 0; i < film.path.data().keyframes.size(); ++i) keyframe_row(state, i);
  }
  file_row(state);
  if (!film.path.empty()) film_rows(state);
}

}  // namespace tureen::viewer
