// Notes and errors, stacked at the upper left.
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

void message_overlay(State& state) {
  const std::vector<Message>& list = state.messages.list();
  if (list.empty()) return;
  ImGui::SetNextWindowPos({8, 8});
  ImGui::SetNextWindowSize({30 * ImGui::GetFontSize(), 0});
  ImGui::Begin("messages", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
  std::optional<std::size_t> dismissed;
  for (std::size_t i = 0; i < list.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    if (list[i].kind == Message::Kind::error) {
      ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0f, 0.55f, 0.45f, 1));
      paragraph(list[i].title);
      ImGui::PopStyleColor();
      paragraph(list[i].text);
      if (ImGui::SmallButton("dismiss")) dismissed = i;
      ImGui::SameLine();
      if (ImGui::SmallButton("copy"))
        ImGui::SetClipboardText((list[i].title + ": " + list[i].text).c_str());
    } else {
      aside(list[i].text);
    }
    ImGui::PopID();
  }
  ImGui::End();
  if (dismissed) state.messages.dismiss(*dismissed);
}

}  // namespace tureen::viewer
