// Remarks of scene/: soft triangles made opaque, fewer splats, merged scenes.
#pragma once

#include "base/decimal_text.hpp"
#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind soft_triangles_opaque{
    "soft_triangles_opaque", Severity::loss, [](const Remark& r) {
      return "soft triangles are drawn opaque: on average, a soft triangle covers " +
             fixed_decimal(100 * r.number("coverage"), 0) + "% of its area (opacity " +
             fixed_decimal(r.number("opacity"), 2) + "), the opaque face covers all of it";
    }};
inline constexpr RemarkKind soft_triangles_dropped{
    "soft_triangles_dropped", Severity::loss, [](const Remark& r) {
      return r.text("dropped") + " of " + r.text("all") + " soft triangles have an opacity below " +
             r.text("smallest_opacity") + ": dropped";
    }};
inline constexpr RemarkKind screen_interpolation_dropped{
    "screen_interpolation_dropped", Severity::loss, [](const Remark&) -> std::string {
      return "colours are interpolated in perspective, but in screen space by the original "
             "renderer: large triangles near the camera differ";
    }};
inline constexpr RemarkKind splats_limited{
    "splats_limited", Severity::loss, [](const Remark& r) {
      return r.text("kept") + " of " + r.text("all") +
             " splats were read: those with the largest opacity times area";
    }};
inline constexpr RemarkKind settings_dropped{
    "settings_dropped", Severity::loss, [](const Remark& r) {
      return "these settings differ from those of the first scene and are ignored: " +
             r.text("settings");
    }};

}  // namespace tureen::remarks
