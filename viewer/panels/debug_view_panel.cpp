// Selects the final colour or a debug view.
#include <algorithm>

#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

void feature_choice(FeatureChoice& choice, int count) {
  field("First");
  ImGui::SliderInt("##first", &choice.first, 0, count - 1, "%d", ImGuiSliderFlags_AlwaysClamp);
  field("Count");
  ImGui::SliderInt("##count", &choice.count, 1, 3, "%d", ImGuiSliderFlags_AlwaysClamp);
  tip("One feature as grey, two or three as red, green and blue");
  choice.count = std::min(choice.count, count - choice.first);
}

}  // namespace

void debug_view_panel(State& state) {
  const SceneSource& source = state.source;
  DebugViewChoice& debug_view = state.debug_view;
  const DebugViewName& current = debug_view_names()[std::size_t(debug_view.what)];
  const Subjects subjects = subjects_of(source);
  field("View");
  if (ImGui::BeginCombo("##view", current.title, ImGuiComboFlags_HeightLarge)) {
    for (const DebugViewName& each : debug_view_names()) {
      if (why_not(each.what, source)) continue;
      if (list_item(each.title, each.what == debug_view.what)) debug_view.what = each.what;
      tip(meaning_of(each, subjects));
    }
    ImGui::EndCombo();
  }
  tip("V: next debug view");
  aside(meaning_of(current, subjects));
  if (debug_view.what == DebugView::features)
    feature_choice(debug_view.features, feature_count(source));
  if (debug_view.what != DebugView::color && state.stage->debug_views)
    legend_rows(state.stage->debug_views->legend());
}

}  // namespace tureen::viewer
