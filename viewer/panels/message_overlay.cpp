// Notes and errors, stacked in the upper left corner of the image: what people look at is in the
// middle.
#include <algorithm>

#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

void message_overlay(State& state) {
  const std::vector<Message>& list = state.messages.list();
  if (list.empty()) return;
  const Palette& colors = palette(state.theme);
  const float em = ImGui::GetFontSize();
  const float width = std::min(26 * em, float(state.points.x) - em);
  ImGui::SetNextWindowPos({0.6f * em, 0.6f * em});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(card_padding(), card_padding()));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::Begin("messages", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                   ImGuiWindowFlags_NoBackground);
  ImGui::PopStyleVar(2);
  std::optional<std::size_t> dismissed;
  for (std::size_t i = 0; i < list.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    const bool error = list[i].kind == Message::Kind::error;
    const Card card({.color = error ? colors.danger_tint : colors.card,
                     .edge = error ? colors.danger : colors.edge});
    if (error) {
      ImGui::PushStyleColor(ImGuiCol_Text, color_of(colors.danger));
      {
        const Bold bold;
        paragraph(list[i].title);
      }
      paragraph(list[i].text);
      ImGui::PopStyleColor();
      if (small_button("Close")) dismissed = i;
      ImGui::SameLine();
      if (small_button("Copy"))
        ImGui::SetClipboardText((list[i].title + ": " + list[i].text).c_str());
    } else {
      paragraph(list[i].text);
    }
    ImGui::PopID();
  }
  ImGui::End();
  if (dismissed) state.messages.dismiss(*dismissed);
}

}  // namespace tureen::viewer
