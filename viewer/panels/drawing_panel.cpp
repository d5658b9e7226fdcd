// The plan in words, and switches for its parts, to see their cost.
// clang-format off: the second header needs the first
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>
// clang-format on

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "runtime/plan/plan_description.hpp"
#include "scene/document/color_text.hpp"
#include "viewer/gui/item_places.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

void sampling(State& state) {
  static constexpr struct {
    const char* name;
    double scale;
    int supersampling;
  } samplings[] = {{"0.25 \u00d7 screen", 0.25, 1},
                   {"0.5 \u00d7 screen", 0.5, 1},
                   {"0.75 \u00d7 screen", 0.75, 1},
                   {"screen", 1, 1},
                   {"2 \u00d7 screen (4 samples per pixel)", 1, 2},
                   {"3 \u00d7 screen (9 samples per pixel)", 1, 3},
                   {"4 \u00d7 screen (16 samples per pixel)", 1, 4},
                   {"8 \u00d7 screen (64 samples per pixel)", 1, 8}};
  const Quality& quality = state.source.document.quality;
  const char* current = "as requested";
  for (const auto& each : samplings)
    if (each.scale == quality.resolution_scale && each.supersampling == quality.supersampling)
      current = each.name;
  field("Resolution");
  if (!ImGui::BeginCombo("##resolution", current)) return;
  for (const auto& each : samplings)
    if (list_item(each.name, each.name == current))
      state.edit(ChangeQuality{{each.scale, each.supersampling, quality.splat_order}});
  ImGui::EndCombo();
}

void background_rows(State& state) {
  glm::vec3 color = background_of(state.source);
  field("Background");
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  ImGui::SetNextItemWidth(9 * ImGui::GetFontSize() - ImGui::GetFrameHeight() - gap);
  ImGui::InputText("##background", &state.background_text, ImGuiInputTextFlags_AutoSelectAll);
  if (ImGui::IsItemDeactivatedAfterEdit() && state.background_text != color_text(color)) {
    const char* refusal = "The background was not changed";
    const auto& messages = state.messages.list();
    const auto earlier = std::ranges::find(messages, refusal, &Message::title);
    if (earlier != messages.end()) state.messages.dismiss(std::size_t(earlier - messages.begin()));
    try {
      color = parse_color(state.background_text);
      state.edit(ChangeBackground{color});
    } catch (const UsageError& error) {
      state.error(refusal, error.what());
    }
  }
  if (!ImGui::IsItemActive()) state.background_text = color_text(color);
  tip("A name such as white, or #ff8000");
  ImGui::SameLine(0, gap);
  if (ImGui::ColorEdit3("##colors", &color.x, ImGuiColorEditFlags_NoInputs))
    state.edit(ChangeBackground{color}, true);
  ImGui::SameLine();
  {
    const Disabled disabled(!state.source.document.background);
    if (button("Reset")) state.edit(ChangeBackground{});
  }
  tip("Use the scene's background");
  check("Checkerboard", &state.shows_checks);
  tip("Show a checkerboard instead of the background");
}

/// The rules of rendering splats. Returns whether the choice changed.
bool splat_rules(State& state, DrawingChoice& choice) {
  const Document& document = state.source.document;
  std::vector<const Splats*> splats;
  for (const DocumentLayer& layer : document.layers)
    if (const Splats* of_layer = splats_of(layer)) splats.push_back(of_layer);
  if (splats.empty()) return false;
  const std::optional<SplatProfile>& profile = document.profile;
  const std::string own = "of the file";
  const std::string current = profile ? std::string(name_of(*profile)) : own;
  field("Profile");
  if (ImGui::BeginCombo("##profile", current.c_str())) {
    if (list_item(own, !profile)) state.edit(ChangeProfile{});
    for (const NamedProfile& each : named_profiles) {
      // Of methods with equal profiles, the first.
      if (name_of(each.profile) != each.name) continue;
      if (std::any_of(splats.begin(), splats.end(), [&](const Splats* of_layer) {
            return profile_defect(of_layer->kernel, each.profile).has_value();
          }))
        continue;
      if (list_item(std::string(each.name), profile == each.profile))
        state.edit(ChangeProfile{each.profile});
    }
    ImGui::EndCombo();
  }
  tip("Method whose rules draw the splats");
  Quality quality = document.quality;
  int order = int(quality.splat_order);
  field("Splat order");
  if (ImGui::Combo("##splat order", &order, splat_order_names.data(),
                   int(splat_order_names.size()))) {
    quality.splat_order = Quality::SplatOrder(order);
    state.edit(ChangeQuality{quality});
  }
  tip("Centre: by the splats' centres. Exact: along the ray of each pixel, slower. Stochastic: "
      "without blending, noisy");
  const bool changed = check("As published", &choice.plan.as_published);
  tip("Also apply the culling rules in the authors' code that depend on the resolution");
  return changed;
}

/// Switches for the specialisations of this plan: to see the gain of each, or to locate a fault.
/// Returns whether the choice changed.
bool specialisations(DrawingChoice& choice, const RenderPlan& plan) {
  bool changed = false;
  for (const SpecialisationName& entry : specialisation_names()) {
    const bool allowed = choice.plan.specialisations.has(entry.what);
    if (allowed && !plan.applies(entry.what)) continue;  // does not apply to this scene
    bool out = allowed;
    if (!check(entry.title, &out)) continue;
    if (out)
      choice.plan.specialisations.add(entry.what);
    else
      choice.plan.specialisations = choice.plan.specialisations.without(entry.what);
    changed = true;
  }
  return changed;
}

/// The plan in sentences, and its specialisations. Returns whether the choice changed.
bool plan_rows(DrawingChoice& choice, const RenderPlan& plan) {
  const bool open = ImGui::TreeNode("Plan and specialisations");
  note_item("Plan and specialisations");
  if (!open) return false;
  bool changed = false;
  if (choice.pipeline == PipelineKind::tureen) {
    changed |= check("Specialise for the scene", &choice.plan.specialise);
    if (choice.plan.specialise) changed |= specialisations(choice, plan);
  }
  for (const std::string& each : describe(plan)) sentence(each);
  ImGui::TreePop();
  return changed;
}

}  // namespace

void drawing_panel(State& state) {
  Stage& stage = *state.stage;
  DrawingChoice choice = state.wanted;
  background_rows(state);
  sampling(state);
  check("Smooth at rest", &state.settings.smooth_at_rest);
  tip("Still views show the mean of 64 frames with different samples. Saved images have the same "
      "samples");
  tracing_rows(state);
  bool changed = splat_rules(state, choice);
  bool baseline = choice.pipeline == PipelineKind::baseline;
  if (check("Baseline", &baseline)) {
    choice.pipeline = baseline ? PipelineKind::baseline : PipelineKind::tureen;
    changed = true;
  }
  tip("Draws soups as in DiffSoup's viewer, and splats as instanced quads");
  if (stage.debug_views)  // the plan is not that of the choice
    aside("Debug views are drawn without these choices.");
  else
    changed |= plan_rows(choice, stage.renderer.plan());
  if (changed) state.ask(ChooseDrawing{choice});
}

}  // namespace tureen::viewer
