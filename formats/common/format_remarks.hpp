// Remarks that readers of several formats make.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind up_unknown_to_format{"up_unknown_to_format", Severity::assumption,
                                                 "{format} stores no up axis: z is assumed", "up"};
inline constexpr RemarkKind splats_dropped{"splats_dropped", Severity::loss,
                                           "{dropped} of {all} splats {dropped:has|have} a value "
                                           "that is not finite or outside its range: dropped"};
inline constexpr RemarkKind coordinates_rounded{
    "coordinates_rounded", Severity::loss, "Coordinates of type double were rounded to float."};
inline constexpr RemarkKind bytes_ignored{"bytes_ignored", Severity::note,
                                          "{bytes} bytes after the last element ignored."};
inline constexpr RemarkKind content_misnamed{
    "content_misnamed", Severity::note,
    "The name ends in {extension}, but the content is {format}."};
inline constexpr RemarkKind chunks_unaligned{"chunks_unaligned", Severity::note,
                                             "The length of a chunk of the GLB is not a multiple "
                                             "of 4, as glTF requires; it is read anyway."};
inline constexpr RemarkKind mean_colors_shown{
    "mean_colors_shown", Severity::loss,
    "{extension} is read only from .glb: mean colours are drawn"};

}  // namespace tureen::remarks
