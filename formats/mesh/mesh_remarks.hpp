// Remarks of the readers of meshes.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind polygons_split{
    "polygons_split", Severity::note,
    "{polygons} {polygons:polygon|polygons} with more than three corners split into triangles."};
inline constexpr RemarkKind small_faces_dropped{
    "small_faces_dropped", Severity::loss,
    "{faces} {faces:face|faces} with fewer than three corners skipped."};
inline constexpr RemarkKind color_components_clamped{
    "color_components_clamped", Severity::loss,
    "{components} colour {components:component|components} outside 0..1 clamped."};
inline constexpr RemarkKind face_colors_dropped{
    "face_colors_dropped", Severity::loss,
    "The file has vertex and face colours; the face colours are ignored."};
inline constexpr RemarkKind colors_missing{
    "colors_missing", Severity::assumption,
    "The file has no colours; everything is drawn grey (0.8)."};
inline constexpr RemarkKind face_colors_missing{
    "face_colors_missing", Severity::assumption,
    "{triangles} {triangles:triangle has no colour and is|triangles have no colour and are} drawn "
    "grey (0.8)."};
inline constexpr RemarkKind face_colors_mapped{
    "face_colors_mapped", Severity::loss,
    "The colours of {faces} {faces:face|faces} are indices of a colour map, which OFF does not "
    "store."};
inline constexpr RemarkKind text_ignored{
    "text_ignored", Severity::note, "Text after the last face, from line {line} on, is ignored."};
inline constexpr RemarkKind up_unknown_to_obj{"up_unknown_to_obj", Severity::assumption,
                                              "OBJ stores no up axis: y is assumed", "up"};
inline constexpr RemarkKind points_and_lines_skipped{
    "points_and_lines_skipped", Severity::loss,
    "{elements} {elements:point or line is|points and lines are} not drawn."};
inline constexpr RemarkKind material_library_missing{
    "material_library_missing", Severity::loss,
    "The material library {library} is not used: {reason}."};
inline constexpr RemarkKind materials_missing{
    "materials_missing", Severity::loss,
    "{materials:material|materials} {materials:and} {materials:is|are} in no library: drawn grey "
    "(0.8)."};
inline constexpr RemarkKind texture_missing{
    "texture_missing", Severity::loss,
    "The texture of the material {material} is not drawn: {reason}."};
inline constexpr RemarkKind texture_placement_dropped{
    "texture_placement_dropped", Severity::loss,
    "The material {material} moves or scales its texture (-o, -s, -t), which is ignored."};
inline constexpr RemarkKind transparency_cut_out{
    "transparency_cut_out", Severity::loss,
    "Transparent materials are drawn as cut-outs at an opacity of 0.5."};
inline constexpr RemarkKind shapes_missing{
    "shapes_missing", Severity::loss,
    "{shapes:shape|shapes} {shapes:and} of {all} missing: the others are drawn"};
inline constexpr RemarkKind shapes_untextured{
    "shapes_untextured", Severity::loss,
    "{shapes:shape|shapes} {shapes:and} of {all} without feature images: the others are drawn"};

}  // namespace tureen::remarks
