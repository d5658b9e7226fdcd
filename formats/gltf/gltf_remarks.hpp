// Remarks of the reader of glTF.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind up_unknown_to_trimesh{
    "up_unknown_to_trimesh", Severity::assumption,
    "trimesh, which wrote the file, stores no up axis: z is assumed", "up"};
inline constexpr RemarkKind corners_dropped{"corners_dropped", Severity::loss,
                                            "{primitive}: {corners} corners are not a multiple of "
                                            "three; the incomplete triangle is skipped"};
inline constexpr RemarkKind splat_colors_linear{
    "splat_colors_linear", Severity::loss,
    "colours will differ: the file expects blending in linear light, and Tureen blends "
    "display-referred colours"};
inline constexpr RemarkKind extensions_dropped{
    "extensions_dropped", Severity::loss,
    "the file uses {extensions}, {extensions:which is|which are} not drawn"};
inline constexpr RemarkKind spz_axes_of_draft{
    "spz_axes_of_draft", Severity::note,
    "the SPZ splats are turned to the axes left, up, front, as the draft of {extension} specifies"};
inline constexpr RemarkKind spz_axes_stored{
    "spz_axes_stored", Severity::assumption,
    "the SPZ splats keep their stored axes, as CesiumJS draws such files: they have no kernel and "
    "colour space"};
inline constexpr RemarkKind vertex_colors_srgb{"vertex_colors_srgb", Severity::note,
                                               "vertex colours are read as sRGB, as requested"};
inline constexpr RemarkKind vertex_colors_linear{"vertex_colors_linear", Severity::note,
                                                 "vertex colours are read as linear, as requested"};
inline constexpr RemarkKind vertex_colors_srgb_by_generator{
    "vertex_colors_srgb_by_generator", Severity::assumption,
    "vertex colours are read as sRGB, because the file's generator stores them so",
    "vertex_colors"};
inline constexpr RemarkKind vertex_colors_linear_by_gltf{
    "vertex_colors_linear_by_gltf", Severity::assumption,
    "vertex colours are read as linear, as glTF specifies", "vertex_colors"};
inline constexpr RemarkKind colors_multiplied{
    "colors_multiplied", Severity::loss,
    "texture, factor and vertex colour are multiplied as display-referred values; this "
    "approximates the product in linear light that glTF specifies"};
inline constexpr RemarkKind materials_unlit{"materials_unlit", Severity::loss,
                                            "lit materials are drawn unlit, by their base colour"};
inline constexpr RemarkKind surfaces_split{
    "surfaces_split", Severity::note,
    "the {layers:material|materials} {layers:and} {layers:is|are} mirrors or glass: each is a "
    "layer "
    "of its own, and only rays show more than its base colour"};
inline constexpr RemarkKind surface_dropped{
    "surface_dropped", Severity::loss,
    "{material} is drawn by its base colour, not as a mirror or glass: {reason}"};
inline constexpr RemarkKind surface_texture_dropped{
    "surface_texture_dropped", Severity::loss,
    "{material}: rays use the factor of its base colour, not the texture"};
inline constexpr RemarkKind blending_cut_out{
    "blending_cut_out", Severity::loss,
    "blended materials are drawn as cut-outs at an alpha of 0.5"};
inline constexpr RemarkKind animations_dropped{"animations_dropped", Severity::loss,
                                               "animations are not played"};
inline constexpr RemarkKind skins_dropped{"skins_dropped", Severity::loss,
                                          "skinned meshes are drawn in their bind pose"};
inline constexpr RemarkKind morph_targets_dropped{"morph_targets_dropped", Severity::loss,
                                                  "morph targets are not applied"};
inline constexpr RemarkKind points_and_lines_dropped{"points_and_lines_dropped", Severity::loss,
                                                     "points and lines are not drawn"};
inline constexpr RemarkKind primitives_without_positions_dropped{
    "primitives_without_positions_dropped", Severity::loss,
    "primitives without POSITION are not drawn"};
inline constexpr RemarkKind other_projections_dropped{
    "other_projections_dropped", Severity::loss, "cameras that are not perspective are skipped"};
inline constexpr RemarkKind blind_cameras_dropped{
    "blind_cameras_dropped", Severity::loss, "cameras without a valid field of view are skipped"};

}  // namespace tureen::remarks
