// Remarks of scene/: soft triangles made opaque, fewer or hidden splats, merged scenes.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind soft_triangles_opaque{
    "soft_triangles_opaque", Severity::loss,
    "soft triangles are drawn opaque: on average, a soft triangle covers {coverage:%} of its area "
    "(opacity {opacity:.2}), the opaque face covers all of it"};
inline constexpr RemarkKind soft_triangles_dropped{
    "soft_triangles_dropped", Severity::loss,
    "{dropped} of {all} soft triangles have an opacity below {smallest_opacity}: dropped"};
inline constexpr RemarkKind screen_interpolation_dropped{
    "screen_interpolation_dropped", Severity::loss,
    "colours are interpolated in perspective, but in screen space by the original renderer: large "
    "triangles near the camera differ"};
inline constexpr RemarkKind splats_limited{
    "splats_limited", Severity::loss,
    "{kept} of {all} splats were read: those with the largest opacity times area"};
inline constexpr RemarkKind near_limit_hides{"near_limit_hides", Severity::assumption,
                                             "the near limit of {limit} units hides {hidden:%} of "
                                             "the splats in the view of the first camera",
                                             "near_limit"};
inline constexpr RemarkKind near_limit_large{
    "near_limit_large", Severity::assumption,
    "the near limit of {limit} units hides splats in usual views: most of them lie within {radius} "
    "units",
    "near_limit"};
inline constexpr RemarkKind settings_dropped{
    "settings_dropped", Severity::loss,
    "these settings differ from those of the first scene and are ignored: {settings}"};
inline constexpr RemarkKind turned_upright{"turned_upright", Severity::assumption,
                                           "turned about the world's origin, so that its up axis, "
                                           "{from}, becomes that of the first scene, "
                                           "{to}",
                                           "keep_axes"};

}  // namespace tureen::remarks
