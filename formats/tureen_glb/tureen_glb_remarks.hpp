// Remarks of the reader of our GLB files.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind preset_dropped{
    "preset_dropped", Severity::loss,
    "the preset selects soft triangles, but some of them are not drawn: the preset is ignored"};
inline constexpr RemarkKind preset_applied{"preset_applied", Severity::note,
                                           "the file's preset was applied to the data: {edits}"};
inline constexpr RemarkKind preset_keys_ignored{
    "preset_keys_ignored", Severity::note,
    "settings of the file's preset that no longer exist are ignored: {keys}"};

}  // namespace tureen::remarks
