// Frame times.
#include <algorithm>
#include <vector>

#include "jobs/timing/frame_statistics.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

void graph(const std::vector<FrameParts>& frames) {
  std::vector<float> device, whole;  // ms
  float most = 1;
  for (const FrameParts& frame : frames) {
    device.push_back(float(frame.device_ms));
    whole.push_back(float(frame.device_ms + frame.processor_ms));
    most = std::max(most, whole.back());
  }
  const ImVec2 size{ImGui::GetContentRegionAvail().x, 5 * ImGui::GetFontSize()};
  const ImVec2 at = ImGui::GetCursorPos();
  const auto count = static_cast<int>(frames.size());
  ImGui::PushStyleColor(ImGuiCol_PlotHistogram, ImGui::GetStyleColorVec4(ImGuiCol_Border));
  ImGui::PlotHistogram("##whole", whole.data(), count, 0, nullptr, 0, most, size);
  ImGui::PopStyleColor();
  ImGui::SetCursorPos(at);
  ImGui::PushStyleColor(ImGuiCol_FrameBg, ImVec4(0, 0, 0, 0));
  ImGui::PushStyleColor(ImGuiCol_PlotHistogram, ImGui::GetStyleColorVec4(ImGuiCol_CheckMark));
  ImGui::PlotHistogram("##device", device.data(), count, 0, nullptr, 0, most, size);
  ImGui::PopStyleColor(2);
}

}  // namespace

void times_panel(State& state, const FrameClock& clock) {
  const std::vector<FrameParts>& frames = clock.frames();
  if (frames.empty()) {
    aside("No frame has been drawn.");
  } else {
    std::vector<double> device, processor;
    for (const FrameParts& frame : frames) {
      device.push_back(frame.device_ms);
      processor.push_back(frame.processor_ms);
    }
    graph(frames);
    fact("Device", fmt::format("{:.2f} ms (blue)", median(device)));
    fact("Processor", fmt::format("{:.2f} ms (grey)", median(processor)));
    aside(fmt::format("Medians of the last {} frames; a frame is drawn when something changes",
                      frames.size()));
    for (const gl::PassTimer::PassTime& pass : clock.passes())
      fact(pass.pass.c_str(), fmt::format("{:.3f} ms", pass.ms));
    if (clock.why_no_passes()) aside(*clock.why_no_passes());
  }
  check("Draw continuously", &state.draw_continuously);
  tip("To measure times; otherwise the window draws only when something changes");
}

}  // namespace tureen::viewer
