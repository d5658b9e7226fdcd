// Widgets that several panels use. Labels stand before their controls, in a column.
#pragma once

#include <fmt/format.h>
#include <imgui/imgui.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "image/heat_map.hpp"
#include "viewer/gui/colors.hpp"

namespace tureen::viewer {

// -- texts ----------------------------------------------------------------------------------------

template <class... Args>
void text(fmt::format_string<Args...> format, Args&&... args) {
  const std::string line = fmt::format(format, std::forward<Args>(args)...);
  ImGui::TextUnformatted(line.data(), line.data() + line.size());
}

/// Text that wraps between words at the panel's edge.
void paragraph(const std::string& words);
/// The same, dimmed: explanations and missing data.
void aside(const std::string& words);
/// The same, with a capital letter at the beginning.
void sentence(std::string words);
/// A bold line above a group of controls.
void heading(const std::string& words);
/// A dimmed name and its value, which wraps.
void fact(const char* name, const std::string& value);
/// A tooltip of the previous item, also of a disabled one.
void tip(const std::string& words);
/// The legend of colours, one row each.
void legend_rows(const Legend& legend);

// -- controls, which sessions click by their labels (viewer/gui/item_places.hpp)
// -------------------

/// A dimmed label in the column of labels. The next item comes at its right and extends to the
/// panel's edge.
void field(const char* label);

bool button(const char* label);
/// A button in the accent's colour: the most likely choice.
bool strong_button(const char* label);
/// Places the next button beside the last item, or below it where the panel is too narrow.
void beside(const char* label);
/// A button as high as a line of text.
bool small_button(const char* label);
/// A button of this width, in points. All have the height of a field.
bool button(const char* label, float width);
/// The width of each of `count` buttons that fill a row.
float share_of_row(int count);
bool check(const char* label, bool* on);
/// The same, in the row of a field.
bool check_beside_field(const char* label, bool* on);
/// Buttons in one frame, of which one is on: of equal width, unless a label needs more. Returns
/// whether the choice changed.
bool segments(const char* id, std::span<const char* const> labels, int& chosen);
/// A choice in an open list. Returns whether it was clicked.
bool list_item(const std::string& name, bool chosen);
/// A thin bar as wide as the window. `fraction`: 0..1.
void progress_bar(double fraction);

/// Distance between the contents of a card and its edge.
float card_padding();

/// A filled rectangle with round corners around the items drawn in its scope. The window's padding
/// must be card_padding() or more.
class Card {
 public:
  struct Look {
    std::uint32_t color, edge;  // 0xrrggbb
  };
  explicit Card(const Look& look);
  ~Card();
  Card(const Card&) = delete;
  Card& operator=(const Card&) = delete;

 private:
  Look look_;
  ImVec2 low_;
  float width_ = 0;
};

/// A window in the middle of the screen, with the items drawn in its scope. While it is open, the
/// other windows take no events. Constructed in every frame, also while it is closed.
class Dialog {
 public:
  Dialog(const char* title, bool open);
  ~Dialog();
  Dialog(const Dialog&) = delete;
  Dialog& operator=(const Dialog&) = delete;
  /// Whether its items are to be drawn.
  bool is_open() const { return open_; }

 private:
  bool begun_ = false, open_ = false;
};

/// Whether the user has pressed the key, also in a field.
bool escape_pressed();
bool enter_pressed();

/// Undoes at the end of its scope, by `end`, what a derived class does at the beginning.
template <void (*end)()>
class Scope {
 public:
  Scope() = default;
  ~Scope() { end(); }
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;
};

/// Uses the bold font in its scope.
struct Bold : Scope<ImGui::PopFont> {
  Bold();
};
/// Uses the large bold font in its scope.
struct Title : Scope<ImGui::PopFont> {
  Title();
};
/// Disables and greys the items drawn in its scope.
struct Disabled : Scope<ImGui::EndDisabled> {
  explicit Disabled(bool disabled) { ImGui::BeginDisabled(disabled); }
};

}  // namespace tureen::viewer
