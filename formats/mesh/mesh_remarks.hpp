// Remarks of the readers of meshes.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

/// "shape 1 of 8 ", "shapes 1, 2 and 5 of 8 ".
inline std::string shapes_of(const Remark& remark) {
  const auto& counts = std::get<std::vector<std::uint64_t>>(remark["shapes"]);
  std::string text = counts.size() == 1 ? "shape " : "shapes ";
  for (std::size_t i = 0; i < counts.size(); ++i)
    text += (i == 0 ? "" : i + 1 < counts.size() ? ", " : " and ") + std::to_string(counts[i]);
  return text + " of " + remark.text("all") + " ";
}

inline constexpr RemarkKind polygons_split{
    "polygons_split", Severity::note, [](const Remark& r) {
      return counted(r.count("polygons"), "polygon", "polygons") +
             " with more than three corners split into triangles.";
    }};
inline constexpr RemarkKind small_faces_dropped{
    "small_faces_dropped", Severity::loss, [](const Remark& r) {
      return counted(r.count("faces"), "face", "faces") + " with fewer than three corners skipped.";
    }};
inline constexpr RemarkKind color_components_clamped{
    "color_components_clamped", Severity::loss, [](const Remark& r) {
      return counted(r.count("components"), "colour component", "colour components") +
             " outside 0..1 clamped.";
    }};
inline constexpr RemarkKind face_colors_dropped{
    "face_colors_dropped", Severity::loss, [](const Remark&) -> std::string {
      return "The file has vertex and face colours; the face colours are ignored.";
    }};
inline constexpr RemarkKind colors_missing{
    "colors_missing", Severity::assumption, [](const Remark&) -> std::string {
      return "The file has no colours; everything is drawn grey (0.8).";
    }};
inline constexpr RemarkKind face_colors_missing{
    "face_colors_missing", Severity::assumption, [](const Remark& r) {
      return counted(r.count("triangles"), "triangle has no colour and is",
                     "triangles have no colour and are") +
             " drawn grey (0.8).";
    }};
inline constexpr RemarkKind face_colors_mapped{
    "face_colors_mapped", Severity::loss, [](const Remark& r) {
      return "The colours of " + counted(r.count("faces"), "face", "faces") +
             " are indices of a colour map, which OFF does not store.";
    }};
inline constexpr RemarkKind text_ignored{"text_ignored", Severity::note, [](const Remark& r) {
                                           return "Text after the last face, from line " +
                                                  r.text("line") + " on, is ignored.";
                                         }};
inline constexpr RemarkKind shapes_missing{"shapes_missing", Severity::loss, [](const Remark& r) {
                                             return shapes_of(r) + "missing: the others are drawn";
                                           }};
inline constexpr RemarkKind shapes_untextured{
    "shapes_untextured", Severity::loss,
    [](const Remark& r) { return shapes_of(r) + "without feature images: the others are drawn"; }};

}  // namespace tureen::remarks
