#include "viewer/shortcuts.hpp"

#include <array>

#include "viewer/axes.hpp"

namespace tureen::viewer {

namespace {

/// Selects the next or previous recorded camera, cyclically.
void step_recorded(State& state, int step) {
  const int count = static_cast<int>(state.recorded_cameras().size());
  if (count == 0) {
    state.note("The scene has no recorded cameras: open a dataset, or a scene with cameras.");
    return;
  }
  const int from = state.recorded < 0 && step < 0 ? 0 : state.recorded;
  state.ask(ShowRecorded{(from + step + count) % count});
}

template <NamedView view>
void look_from(State& state) {
  state.controls.set_mode(NavigationMode::orbit);
  state.controls.look_from(view);
}

void next_up(State& state) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < up_axes.size(); ++i)
    if (is_axis(state.controls.up(), up_axes[i])) next = (i + 1) % up_axes.size();
  state.controls.set_up(up_axes[next]);
  state.note("The up axis is now " + axis_name(up_axes[next]) + ".");
}

/// Scenes of 3DGS often have y downwards, and no file says so.
void turn_over(State& state) {
  state.controls.set_up(-state.controls.up());
  state.note("The scene is turned upside down.");
}

void next_debug_view(State& state) {
  if (!state.stage) return;
  const auto names = debug_view_names();
  std::size_t next = std::size_t(state.debug_view.what);
  do next = (next + 1) % names.size();
  while (why_not(names[next].what, state.source));
  state.debug_view.what = names[next].what;
}

void next_comparison(State& state) {
  if (!state.photographs) {
    state.note("There are no photographs to compare with: open a dataset.");
    return;
  }
  state.comparison.show = static_cast<Comparison::Show>((int(state.comparison.show) + 1) % 4);
}

void switch_mode(State& state) {
  const bool flies = state.controls.mode() == NavigationMode::fly;
  state.controls.set_mode(flies ? NavigationMode::orbit : NavigationMode::fly);
}

void save_image(State& state) {
  state.ask(TakeImage{state.image.window_size ? glm::ivec2(0) : state.image.size,
                      state.image.transparent});
}

void show_files(State& state) { state.show_files = !state.show_files; }
void show_keys(State& state) { state.show_keys = !state.show_keys; }
void fill_screen(State& state) { state.ask(ToggleFullscreen{}); }

// The keys and words of the page (web/page/viewer_page.ts), where both do the same. Browsers use
// Ctrl and the function keys, so the window has further keys for these actions.
// clang-format off
constexpr const char *moving = "Moving", *keys = "Keys", *path = "Camera path", *window = "Window";
const std::array table = {
    Shortcut{Key::digit_1, With::nothing, moving, nullptr, look_from<NamedView::front>},
    Shortcut{Key::digit_2, With::nothing, moving, nullptr, look_from<NamedView::back>},
    Shortcut{Key::digit_3, With::nothing, moving, nullptr, look_from<NamedView::left>},
    Shortcut{Key::digit_4, With::nothing, moving, nullptr, look_from<NamedView::right>},
    Shortcut{Key::digit_5, With::nothing, moving, nullptr, look_from<NamedView::top>},
    Shortcut{Key::digit_6, With::nothing, moving, nullptr, look_from<NamedView::bottom>},
    Shortcut{Key::digit_7, With::nothing, moving, nullptr, look_from<NamedView::three_quarter>},
    Shortcut{Key::digit_8, With::nothing, moving, nullptr, look_from<NamedView::three_quarter_left>},
    Shortcut{Key::digit_9, With::nothing, moving, nullptr, look_from<NamedView::three_quarter_back>},
    Shortcut{Key::home, With::nothing, moving, "frame the scene from a corner, as 7; angle 40\u00b0",
             [](State& s) { s.controls.set_mode(NavigationMode::orbit); s.controls.home(); }},
    Shortcut{Key::f, With::nothing, keys, "frame the whole scene",
             [](State& s) { s.controls.set_mode(NavigationMode::orbit); s.controls.frame(); }},
    Shortcut{Key::r, With::nothing, keys, "return to the first view and its up axis",
             [](State& s) { s.controls.set_mode(NavigationMode::orbit); s.controls.reset(); }},
    Shortcut{Key::m, With::nothing, keys, "switch between orbit and fly", switch_mode},
    Shortcut{Key::tab, With::nothing, keys, nullptr, switch_mode},
    Shortcut{Key::u, With::nothing, keys, "change the up axis", next_up},
    Shortcut{Key::i, With::nothing, keys, "turn the scene upside down", turn_over},
    Shortcut{Key::g, With::nothing, keys, "gizmo: off, move, turn, scale",
             [](State& s) { s.gizmo.tool = GizmoTool((int(s.gizmo.tool) + 1) % 4); }},
    Shortcut{Key::left_bracket, With::nothing, keys, "previous recorded camera",
             [](State& s) { step_recorded(s, -1); }},
    Shortcut{Key::right_bracket, With::nothing, keys, "next recorded camera",
             [](State& s) { step_recorded(s, 1); }},
    Shortcut{Key::v, With::nothing, keys, "next debug view", next_debug_view},
    Shortcut{Key::l, With::nothing, keys, "ray-trace the still view",
             [](State& s) { s.trace = !s.trace; }},
    Shortcut{Key::c, With::nothing, keys, "photograph: off, split, alone, difference", next_comparison},
    Shortcut{Key::p, With::nothing, keys, "save the image", save_image},
    Shortcut{Key::s, With::control_shift, keys, nullptr, save_image},
    Shortcut{Key::s, With::control, keys, "save the scene", [](State& s) { s.ask(SaveScene{}); }},
    Shortcut{Key::z, With::control, keys, "undo", [](State& s) { s.ask(Undo{}); }},
    Shortcut{Key::y, With::control, keys, "redo; also Ctrl+Shift+Z",
             [](State& s) { s.ask(Redo{}); }},
    Shortcut{Key::z, With::control_shift, keys, nullptr, [](State& s) { s.ask(Redo{}); }},
    Shortcut{Key::c, With::control, keys, "copy the tureen render command",
             [](State& s) { s.ask(CopyCommand{}); }},
    Shortcut{Key::o, With::nothing, keys, "open a scene", show_files},
    Shortcut{Key::o, With::control, keys, nullptr, show_files},
    Shortcut{Key::k, With::nothing, path, "add this view to the camera path",
             [](State& s) { s.ask(AddKeyframe{}); }},
    Shortcut{Key::space, With::nothing, path, "play or stop the camera path",
             [](State& s) {
               if (s.animation.path.empty())
                 s.note("There is no camera path: press K to add the view to one.");
               s.animation.toggle();
             }},
    Shortcut{Key::h, With::nothing, window, "show or hide the panel",
             [](State& s) { s.show_interface = !s.show_interface; }},
    Shortcut{Key::x, With::nothing, window, "full screen on or off", fill_screen},
    Shortcut{Key::f11, With::nothing, window, nullptr, fill_screen},
    Shortcut{Key::t, With::nothing, window, "light or dark theme",
             [](State& s) { s.settings.theme = s.settings.theme == Theme::dark ? Theme::light
                                                                               : Theme::dark; }},
    Shortcut{Key::f1, With::nothing, window, "show this list; also ?", show_keys},
    Shortcut{Key::f5, With::nothing, window, "read the files again", [](State& s) { s.ask(ReloadScene{}); }},
    Shortcut{Key::escape, With::nothing, window, "close lists over the image",
             [](State& s) { (s.show_keys ? s.show_keys : s.show_files) = false; }},
    Shortcut{Key::q, With::control, window, "quit", [](State& s) { s.ask(Quit{}); }},
};
// clang-format on

}  // namespace

std::span<const Shortcut> shortcuts() { return table; }

bool run_shortcut(Key key, With with, State& state) {
  for (const Shortcut& shortcut : table)
    if (shortcut.key == key && shortcut.with == with) {
      shortcut.run(state);
      return true;
    }
  return false;
}

}  // namespace tureen::viewer
