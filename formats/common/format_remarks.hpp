// Remarks that readers of several formats make.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind up_unknown_to_format{
    "up_unknown_to_format", Severity::assumption,
    [](const Remark& r) { return r.text("format") + " stores no up axis: z is assumed"; }, "up"};
inline constexpr RemarkKind splats_dropped{
    "splats_dropped", Severity::loss, [](const Remark& r) {
      return r.text("dropped") + " of " + r.text("all") + " splats " +
             (r.count("dropped") == 1 ? "has" : "have") +
             " a value that is not finite or outside its range: dropped";
    }};
inline constexpr RemarkKind coordinates_rounded{
    "coordinates_rounded", Severity::loss, [](const Remark&) -> std::string {
      return "Coordinates of type double were rounded to float.";
    }};
inline constexpr RemarkKind bytes_ignored{
    "bytes_ignored", Severity::note,
    [](const Remark& r) { return r.text("bytes") + " bytes after the last element ignored."; }};
inline constexpr RemarkKind content_misnamed{
    "content_misnamed", Severity::note, [](const Remark& r) {
      return "The name ends in " + r.text("extension") + ", but the content is " +
             r.text("format") + ".";
    }};
inline constexpr RemarkKind mean_colors_shown{
    "mean_colors_shown", Severity::loss, [](const Remark& r) {
      return r.text("extension") + " is read only from .glb: mean colours are drawn";
    }};

}  // namespace tureen::remarks
