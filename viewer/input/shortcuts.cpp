#include "viewer/input/shortcuts.hpp"

#include <array>

#include "viewer/axes.hpp"

namespace tureen::viewer {

namespace {

/// Selects the next or previous recorded camera, cyclically.
void step_recorded(State& state, int step) {
  const int count = static_cast<int>(state.recorded_cameras().size());
  if (count == 0) {
    state.messages.note("There are no recorded cameras: open a dataset, or a scene with cameras",
                        state.now);
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
  state.messages.note("Up is now " + axis_name(up_axes[next]), state.now);
}

/// Scenes of 3DGS often have y downwards, and no file says so.
void turn_over(State& state) {
  const glm::dvec3 up = -state.controls.up();
  state.controls.set_up(up);
  state.messages.note("Upside down: up is now " + axis_name(up), state.now);
}

void next_debug_view(State& state) {
  if (!state.stage) return;
  const auto names = debug_view_names();
  std::size_t next = std::size_t(state.debug_view.what);
  do next = (next + 1) % names.size();
  while (why_not(names[next].what, *state.stage));
  state.debug_view.what = names[next].what;
}

void next_comparison(State& state) {
  if (!state.photographs) {
    state.messages.note("There are no photographs to compare with: open a dataset", state.now);
    return;
  }
  state.comparison.show = static_cast<Comparison::Show>((int(state.comparison.show) + 1) % 4);
}

// clang-format off
constexpr const char *looking = "Navigation", *views = "Views", *images = "Images",
                     *window = "Window";
const std::array table = {
    Shortcut{Key::tab, false, looking, "change between orbit and fly",
             [](State& s) { s.controls.set_mode(s.controls.mode() == NavigationMode::orbit
                                                    ? NavigationMode::fly : NavigationMode::orbit); }},
    Shortcut{Key::f, false, looking, "show the whole scene",
             [](State& s) { s.controls.set_mode(NavigationMode::orbit); s.controls.frame(); }},
    Shortcut{Key::r, false, looking, "return to the first view",
             [](State& s) { s.controls.set_mode(NavigationMode::orbit); s.controls.reset(); }},
    Shortcut{Key::home, false, looking, "show the scene from three sides",
             [](State& s) { s.controls.set_mode(NavigationMode::orbit); s.controls.home(); }},
    Shortcut{Key::u, false, looking, "change the up axis", next_up},
    Shortcut{Key::i, false, looking, "turn the scene upside down", turn_over},
    Shortcut{Key::digit_1, false, views, "front", look_from<NamedView::front>},
    Shortcut{Key::digit_2, false, views, "back", look_from<NamedView::back>},
    Shortcut{Key::digit_3, false, views, "left", look_from<NamedView::left>},
    Shortcut{Key::digit_4, false, views, "right", look_from<NamedView::right>},
    Shortcut{Key::digit_5, false, views, "top", look_from<NamedView::top>},
    Shortcut{Key::digit_6, false, views, "bottom", look_from<NamedView::bottom>},
    Shortcut{Key::digit_7, false, views, "three-quarter", look_from<NamedView::three_quarter>},
    Shortcut{Key::digit_8, false, views, "three-quarter from the left",
             look_from<NamedView::three_quarter_left>},
    Shortcut{Key::digit_9, false, views, "three-quarter from behind",
             look_from<NamedView::three_quarter_back>},
    Shortcut{Key::left_bracket, false, views, "previous recorded camera",
             [](State& s) { step_recorded(s, -1); }},
    Shortcut{Key::right_bracket, false, views, "next recorded camera",
             [](State& s) { step_recorded(s, 1); }},
    Shortcut{Key::c, false, views, "photograph: off, split, alone, difference", next_comparison},
    Shortcut{Key::v, false, views, "next debug view", next_debug_view},
    Shortcut{Key::k, false, images, "add this view to the camera path",
             [](State& s) { s.ask(AddKeyframe{}); }},
    Shortcut{Key::space, false, images, "play or stop the camera path",
             [](State& s) {
               if (s.animation.path.empty())
                 s.messages.note("There is no camera path: press K to add the view to one", s.now);
               s.animation.toggle();
             }},
    Shortcut{Key::s, true, images, "save the image",
             [](State& s) { s.ask(TakeImage{s.image.window_size ? glm::ivec2(0) : s.image.size,
                                              s.image.transparent}); }},
    Shortcut{Key::c, true, images, "copy the tureen render command for the image",
             [](State& s) { s.ask(CopyCommand{}); }},
    Shortcut{Key::o, true, window, "open a file", [](State& s) { s.show_files = !s.show_files; }},
    Shortcut{Key::h, false, window, "hide or show the panels",
             [](State& s) { s.show_interface = !s.show_interface; }},
    Shortcut{Key::f1, false, window, "list of keys", [](State& s) { s.show_keys = !s.show_keys; }},
    Shortcut{Key::f5, false, window, "read the file again", [](State& s) { s.ask(ReloadScene{}); }},
    Shortcut{Key::f11, false, window, "full screen", [](State& s) { s.ask(ToggleFullscreen{}); }},
    Shortcut{Key::escape, false, window, "close lists over the image",
             [](State& s) { s.show_keys = s.show_files = false; }},
    Shortcut{Key::q, true, window, "quit", [](State& s) { s.ask(Quit{}); }},
};
// clang-format on

}  // namespace

std::span<const Shortcut> shortcuts() { return table; }

bool run_shortcut(Key key, bool control, State& state) {
  for (const Shortcut& shortcut : table)
    if (shortcut.key == key && shortcut.control == control) {
      shortcut.run(state);
      return true;
    }
  return false;
}

}  // namespace tureen::viewer
