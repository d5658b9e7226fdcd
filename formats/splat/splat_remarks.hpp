// Remarks of the readers of splats.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind up_unknown_to_splats{"up_unknown_to_splats", Severity::assumption,
                                                 "{format} stores no up axis: -y is assumed, as in "
                                                 "COLMAP; scenes trained on Blender images have +z",
                                                 "up"};
inline constexpr RemarkKind profile_assumed{
    "profile_assumed", Severity::assumption,
    "the file does not store how its splats are rendered: the profile {profile} is assumed",
    "profile"};
inline constexpr RemarkKind render_mode_unknown{
    "render_mode_unknown", Severity::assumption,
    "the render mode '{mode}' of the file is unknown: the profile {profile} is used", "profile"};
inline constexpr RemarkKind near_limit_lowered{
    "near_limit_lowered", Severity::assumption,
    "The splats lie within {radius} units: the published limit of {published} units, before which "
    "no splat is drawn, is lowered to {limit}",
    "near_limit"};
inline constexpr RemarkKind filter_applied{
    "filter_applied", Severity::note,
    "The filter of Mip-Splatting (filter_3D) was applied to scales and opacities."};
inline constexpr RemarkKind octagon_q_assumed{"octagon_q_assumed", Severity::assumption,
                                              "the file does not store the radius of its octagons, "
                                              "sqrt(Q) standard deviations: Q = {q} is assumed",
                                              "octagon_q"};
inline constexpr RemarkKind splat_extensions_ignored{
    "splat_extensions_ignored", Severity::loss,
    "extensions of the file that are not supported are ignored: {extensions}"};

}  // namespace tureen::remarks
