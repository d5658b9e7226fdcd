// A training run: its progress, its curves, and the buttons that pause and finish it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "base/decimal_text.hpp"
#include "base/shown_text.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

using trainer::RunCommand;
using trainer::TrainingRecord;

ImU32 pale() { return ImGui::GetColorU32(ImGuiCol_Border); }
ImU32 blue() { return ImGui::GetColorU32(ImGuiCol_CheckMark); }

struct CurvePoint {
  double seconds = 0, value = 0;  // finite
};

struct TrainingCurve {
  ImU32 color = blue();
  std::vector<CurvePoint> points = {};
};

void add_finite(TrainingCurve& curve, double seconds, double value) {
  if (std::isfinite(value)) curve.points.push_back({seconds, value});
}

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// 0..1; the middle if there is only one value.
  double fraction(double value) const { return high > low ? (value - low) / (high - low) : 0.5; }
};

/// Draws the curves from the start of the run on, with the limits of both axes. Draws nothing
/// without a point.
void draw_curves(int places, std::span<const TrainingCurve> curves) {
  Extent seconds, values;
  seconds.include(0);
  for (const TrainingCurve& curve : curves)
    for (const CurvePoint& point : curve.points) {
      seconds.include(point.seconds);
      values.include(point.value);
    }
  if (values.low > values.high) return;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size{ImGui::GetContentRegionAvail().x, 5 * ImGui::GetFontSize()};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_Button),
                     ImGui::GetStyle().FrameRounding);
  std::vector<ImVec2> line;
  for (const TrainingCurve& curve : curves) {
    line.clear();
    for (const CurvePoint& point : curve.points)
      line.emplace_back(at.x + size.x * float(seconds.fraction(point.seconds)),
                        at.y + size.y * float(1 - values.fraction(point.value)));
    list.AddPolyline(line.data(), int(line.size()), curve.color, 0, 1.5f);
    // Also visible with one point.
    if (!line.empty()) list.AddCircleFilled(line.back(), 2.5f, curve.color);
  }
  const auto label = [&](const std::string& words, float right, float down) {
    const ImVec2 extent = ImGui::CalcTextSize(words.c_str());
    list.AddText(
        {at.x + 5 + right * (size.x - extent.x - 10), at.y + 2 + down * (size.y - extent.y - 4)},
        ImGui::GetColorU32(ImGuiCol_TextDisabled), words.c_str());
  };
  label(fixed_decimal(values.high, places), 0, 0);
  label(fixed_decimal(values.low, places), 0, 1);
  label(duration_text(seconds.high), 1, 1);
  ImGui::Dummy(size);
}

std::string last_value(const TrainingCurve& curve, int places) {
  return curve.points.empty() ? "not measured yet"
                              : fixed_decimal(curve.points.back().value, places);
}

void training_curves(const std::vector<TrainingRecord>& records) {
  TrainingCurve loss, seen{.color = pale()}, held_out;
  for (const TrainingRecord& record : records) {
    add_finite(loss, record.seconds, record.loss);
    add_finite(seen, record.seconds, record.train_psnr_db);
    if (record.test_psnr_db) add_finite(held_out, record.seconds, *record.test_psnr_db);
  }
  fact("Loss", last_value(loss, 4));
  draw_curves(4, {&loss, 1});
  fact("PSNR in dB", last_value(held_out, 2));
  const TrainingCurve psnr[] = {seen, held_out};
  draw_curves(2, psnr);
  tip("blue: held-out views, at most five, at the run's scale with one sample per pixel; grey: the "
      "step's views");
}

std::string progress_words(const TrainingRecord& last, const std::optional<RunCommand>& command) {
  if (last.ended_early) return "ended early";
  if (last.steps && last.step >= *last.steps) return "complete";
  if (!command) return "not in progress";
  if (*command == RunCommand::pause) return "paused";
  if (*command == RunCommand::finish) return "ends after this step";
  if (last.seconds_left) return duration_text(*last.seconds_left) + " left";
  if (!last.steps || !(last.it_per_second > 0)) return "in progress";
  return duration_text((*last.steps - last.step) / last.it_per_second) + " left";
}

void training_progress(const FollowedTraining& training) {
  const TrainingRecord& last = training.records().back();
  const std::string of = last.steps ? " of " + counted(std::uint64_t(*last.steps)) : "";
  paragraph("step " + counted(std::uint64_t(last.step)) + of + ", " +
            progress_words(last, training.command()));
  if (last.steps) progress_bar(double(last.step) / double(*last.steps));
  aside(fmt::format("{} {}, {} steps/s", counted(last.primitives.count),
                    name_of(last.primitives.kind), short_decimal(last.it_per_second, 3)));
}

void training_buttons(State& state) {
  const std::optional<RunCommand> command = state.training->command();
  const Disabled disabled(!command || *command == RunCommand::finish);
  const bool paused = command == RunCommand::pause;
  if (button(paused ? "Continue" : "Pause"))
    state.ask(TellTraining{paused ? RunCommand::run : RunCommand::pause});
  ImGui::SameLine();
  if (button("Stop and keep")) ImGui::OpenPopup("stop");
  tip("Finishes the run early: writes and measures the scene");
  if (!ImGui::BeginPopup("stop")) return;
  text("A stopped run cannot be continued.");
  if (button("Stop now")) {
    state.ask(TellTraining{RunCommand::finish});
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

}  // namespace

void training_panel(State& state) {
  const FollowedTraining& training = *state.training;
  if (!training.problem().empty()) paragraph(shown_line(training.problem()));
  for (const std::string& line : training.plan()) aside(shown_line(line));
  if (training.records().empty()) {
    aside(training.command() ? "The log has no record yet." : "No run is in progress.");
  } else {
    training_progress(training);
    training_curves(training.records());
  }
  training_buttons(state);
  if (state.photographs) aside("[ and ] select photographs, C compares");
}

}  // namespace tureen::viewer
