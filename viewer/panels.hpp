// The panels around the image. Each is a file in panels/ that reads the state, changes settings in
// it and adds requests to it (viewer/state.hpp).
#pragma once

#include "viewer/frame_clock.hpp"
#include "viewer/state.hpp"

namespace tureen::viewer {

/// Width of the panels, in points; 0 if they are hidden.
double panels_width(const State& state, double window_width);

/// The column of panels on the right.
void draw_panels(State& state, const FrameClock& clock);

/// The overlays on the image: photographs, progress, messages, keys. Drawn with or without the
/// panels.
void draw_overlays(State& state);

// The parts of both, in their order. Panels are drawn between ImGui::Begin and End.
void scene_panel(State& state);
void training_panel(State& state);
void layers_panel(State& state);
void view_panel(State& state);
void debug_view_panel(State& state);
void drawing_panel(State& state);
/// Rows of the panel Drawing.
void tracing_rows(State& state);
/// " · ray tracing, 3 of 16 samples", " · ray-traced"; empty without rays.
std::string tracing_text(const TracedView& traced);
void comparison_panel(State& state);
/// Buttons that train a scene from the photographs, and that close them.
void dataset_buttons(State& state);
/// The training that this window has started, with a button that stops it. Nothing if there is
/// none.
void started_training_rows(State& state);
void image_panel(State& state);
void path_panel(State& state);
void times_panel(State& state, const FrameClock& clock);
void window_panel(State& state);

void traced_overlay(const State& state);
void gizmo_overlay(State& state);
void photograph_overlay(State& state);
void status_overlay(const State& state);
void progress_overlay(State& state);
void message_overlay(State& state);
void keys_overlay(State& state);
void files_overlay(State& state);
void welcome_overlay(State& state);
/// The dialogs before a training starts, and before the window is closed during it.
void training_dialogs(State& state);
void cameras_dialog(State& state);
/// The dialogs about saving, and before unsaved changes are lost.
void saving_dialogs(State& state);

}  // namespace tureen::viewer
