// A window to pick a file or a folder in; typed paths count as well.
// clang-format off: the second header wants the first
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>
// clang-format on

#include <algorithm>
#include <filesystem>

#include "formats/scene_file.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

namespace fs = std::filesystem;

/// A folder with more is cut off, and says so.
constexpr std::size_t most_entries = 2000;

struct Listing {
  fs::path folder;
  std::vector<fs::directory_entry> entries;  // folders first, by name
  bool cut = false;
  std::string trouble;
};

bool is_scene_name(const fs::path& path) {
  for (const FormatInfo& format : known_formats())
    for (const std::string& extension : format.extensions)
      if (format.can_read && path.extension() == extension) return true;
  return path.filename() == "transforms.json";
}

Listing list_of(const fs::path& folder) {
  Listing listing{.folder = folder, .entries = {}, .cut = false, .trouble = ""};
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    if (entry->path().filename().string().starts_with('.')) continue;
    std::error_code ignored;
    if (!entry->is_directory(ignored) && !is_scene_name(entry->path())) continue;
    if ((listing.cut = listing.entries.size() == most_entries)) break;
    listing.entries.push_back(*entry);
  }
  if (failed) listing.trouble = failed.message();
  std::sort(listing.entries.begin(), listing.entries.end(), [](const auto& a, const auto& b) {
    std::error_code ignored;
    const bool a_folder = a.is_directory(ignored), b_folder = b.is_directory(ignored);
    return a_folder != b_folder ? a_folder : a.path().filename() < b.path().filename();
  });
  return listing;
}

void open(State& state, const fs::path& path) {
  state.ask(OpenPath{path});
  state.show_files = false;
}

void folder_buttons(State& state, const Listing& listing, fs::path& next) {
  if (ImGui::Button("Up")) next = listing.folder.parent_path();
  ImGui::SameLine();
  if (ImGui::Button("Open this folder")) open(state, listing.folder);
  tip("A dataset, a DiffSoup export, a MobileNeRF scene");
}

void typed_path(State& state) {
  static std::string typed;
  ImGui::SetNextItemWidth(-5 * ImGui::GetFontSize());
  const bool entered = ImGui::InputTextWithHint("##path", "or type a path", &typed,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  if ((ImGui::Button("Open") || entered) && !typed.empty()) open(state, typed);
}

}  // namespace

void files_overlay(State& state) {
  static Listing listing;
  if (listing.folder.empty()) {
    std::error_code ignored;
    const fs::path start = state.stage ? fs::absolute(state.stage->path, ignored).parent_path()
                                       : fs::current_path(ignored);
    listing = list_of(start);
  }
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * window.x, 0.5f * window.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(36 * ImGui::GetFontSize(), window.x),
                            std::min(28 * ImGui::GetFontSize(), window.y)},
                           ImGuiCond_Appearing);
  fs::path next;
  ImGui::Begin("Open", &state.show_files,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  paragraph(listing.folder.string());
  folder_buttons(state, listing, next);
  ImGui::BeginChild("list", {0, -2 * ImGui::GetFrameHeightWithSpacing()}, true);
  if (!listing.trouble.empty()) aside(listing.trouble);
  if (listing.entries.empty() && listing.trouble.empty())
    aside("No folder here, and no file that can be shown.");
  for (const fs::directory_entry& entry : listing.entries) {
    std::error_code ignored;
    const bool folder = entry.is_directory(ignored);
    const std::string name = entry.path().filename().string() + (folder ? "/" : "");
    if (!ImGui::Selectable(name.c_str())) continue;
    if (folder)
      next = entry.path();
    else
      open(state, entry.path());
  }
  if (listing.cut) aside("There is more; type the path.");
  ImGui::EndChild();
  typed_path(state);
  ImGui::End();
  if (!next.empty()) listing = list_of(next);
  if (!state.show_files) listing = {};
}

}  // namespace tureen::viewer
