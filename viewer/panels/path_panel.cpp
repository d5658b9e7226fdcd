// Camera paths: keyframes, playing, turntables, files, animations.
// clang-format off: the second header needs the first
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>
// clang-format on

#include <algorithm>
#include <cfloat>
#include <glm/common.hpp>
#include <optional>
#include <span>

#include "image/video_file.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

/// Longest path, in seconds.
constexpr double longest = 3600;

void play_row(Animation& animation) {
  const double duration = animation.path.duration();
  if (button(animation.plays ? "Pause" : "Play")) animation.toggle();
  tip("Space: play or stop the camera path");
  ImGui::SameLine();
  auto seconds = static_cast<float>(animation.seconds);
  ImGui::SetNextItemWidth(-FLT_MIN);
  if (ImGui::SliderFloat("##seconds", &seconds, 0, static_cast<float>(duration), "%.2f s",
                         ImGuiSliderFlags_AlwaysClamp))
    animation.seconds = seconds;
  animation.scrubbed = ImGui::IsItemActive();
}

void loop_row(Animation& animation) {
  bool loop = animation.path.is_loop();
  if (check("Loop", &loop))
    animation.path.set_loop_seconds(loop ? animation.path.duration() + 1 : 0);
  if (!loop) return;
  auto seconds = static_cast<float>(animation.path.data().loop_seconds);
  field("Seconds");
  if (ImGui::DragFloat("##seconds a loop", &seconds, 0.05f, 0.1f, float(longest), "%.2f",
                       ImGuiSliderFlags_AlwaysClamp))
    animation.path.set_loop_seconds(seconds);
}

void keyframe_row(State& state, std::size_t index) {
  Animation& animation = state.animation;
  const CameraKeyframe& keyframe = animation.path.data().keyframes[index];
  ImGui::PushID(static_cast<int>(index));
  ImGui::AlignTextToFramePadding();
  if (ImGui::Selectable(fmt::format("{}", index + 1).c_str(), animation.selected == int(index), 0,
                        {2 * ImGui::GetFontSize(), 0})) {
    animation.selected = int(index);
    animation.plays = false;
    animation.seconds = keyframe.seconds - animation.path.begin();
    state.ask(ShowKeyframe{index});
  }
  ImGui::SameLine();
  auto seconds = static_cast<float>(keyframe.seconds);
  ImGui::SetNextItemWidth(5 * ImGui::GetFontSize());
  // Between its neighbours, so that the rows keep their order.
  const auto& all = animation.path.data().keyframes;
  const double earliest = index > 0 ? all[index - 1].seconds : 0;
  const double latest = index + 1 < all.size() ? all[index + 1].seconds : longest;
  std::optional<double> moved_to;
  if (ImGui::DragFloat("##s", &seconds, 0.02f, float(earliest), float(latest), "%.2f s",
                       ImGuiSliderFlags_AlwaysClamp))
    moved_to = std::clamp(double(seconds), earliest, latest);
  ImGui::SameLine();
  const bool replaced = small_button("Replace");
  tip("Replaces the keyframe by the current view");
  ImGui::SameLine();
  const bool removed = small_button("Remove");
  ImGui::PopID();
  if (moved_to) animation.path.move(index, *moved_to);
  if (replaced) animation.path.replace(index, state.keyframe_of_now(keyframe.seconds));
  if (!removed) return;
  animation.path.remove(index);
  animation.selected = -1;
  animation.seconds = std::min(animation.seconds, animation.path.duration());
}

void file_row(State& state) {
  Animation& animation = state.animation;
  field("File");
  ImGui::InputTextWithHint("##file", "path.json", &animation.file);
  {
    const Disabled disabled(animation.path.empty());
    if (button("Save")) state.ask(SavePath{animation.file.empty() ? "path.json" : animation.file});
  }
  ImGui::SameLine();
  if (button("Load")) state.ask(LoadPath{animation.file.empty() ? "path.json" : animation.file});
  tip("All commands with cameras read this file: tureen render SCENE --path path.json");
}

void animation_rows(State& state) {
  Animation& animation = state.animation;
  static const bool videos = have_ffmpeg();
  static constexpr const char* outputs[] = {"PNG frames", "MP4", "WebM"};
  int output = static_cast<int>(animation.output);
  segments("output", std::span(outputs).first(videos ? 3 : 1), output);
  if (!videos) aside(ffmpeg_missing);
  animation.output = static_cast<Animation::Output>(output);
  field("Pixels");
  ImGui::InputInt2("##pixels", &animation.size.x);
  animation.size = glm::clamp(animation.size, 1, 8192);
  auto rate = static_cast<float>(animation.frames_per_second);
  field("Frames/s");
  if (ImGui::DragFloat("##frames/s", &rate, 0.1f, 1, 240, "%.0f", ImGuiSliderFlags_AlwaysClamp))
    animation.frames_per_second = rate;
  const double count = frame_count(animation.path, animation.frames_per_second);
  fact("Frames", fmt::format("{:.0f}", count));
  if (button("Write the animation")) state.ask(WriteAnimation{});
}

}  // namespace

void path_panel(State& state) {
  Animation& animation = state.animation;
  if (button("Add this view")) state.ask(AddKeyframe{});
  tip("K: add this view to the camera path");
  ImGui::SameLine();
  if (button("Turntable")) state.ask(MakeTurntable{});
  tip("One turn around the target from this view, in this number of seconds; replaces the path");
  ImGui::SameLine();
  auto seconds = static_cast<float>(animation.turn_seconds);
  ImGui::SetNextItemWidth(5 * ImGui::GetFontSize());
  if (ImGui::DragFloat("##turn", &seconds, 0.05f, 0.5f, 600, "%.1f s",
                       ImGuiSliderFlags_AlwaysClamp))
    animation.turn_seconds = seconds;
  if (!state.recorded_cameras().empty()) {
    if (button("Fly along the cameras")) state.ask(FlyAlongCameras{});
    tip("A smooth path along the recorded cameras; replaces the path");
  }
  if (animation.path.empty()) {
    aside("Add views: they become a smooth camera path.");
  } else {
    play_row(animation);
    loop_row(animation);
    // Flights along cameras have many.
    const float shown = std::min(float(animation.path.data().keyframes.size()), 6.0f);
    ImGui::BeginChild("keyframes", {0, shown * ImGui::GetFrameHeightWithSpacing()});
    for (std::size_t i = 0; i < animation.path.data().keyframes.size(); ++i) keyframe_row(state, i);
    ImGui::EndChild();
  }
  file_row(state);
  if (!animation.path.empty()) animation_rows(state);
}

}  // namespace tureen::viewer
