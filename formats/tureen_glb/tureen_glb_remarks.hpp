// Remarks of the reader of our GLB files.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind preset_dropped{"preset_dropped", Severity::loss,
                                           [](const Remark&) -> std::string {
                                             return "the preset selects soft triangles, but some "
                                                    "of them are not drawn: the preset is ignored";
                                           }};
inline constexpr RemarkKind preset_applied{"preset_applied", Severity::note, [](const Remark& r) {
                                             return "the file's preset was applied to the data: " +
                                                    r.text("edits");
                                           }};
inline constexpr RemarkKind preset_keys_ignored{
    "preset_keys_ignored", Severity::note, [](const Remark& r) {
      return "settings of the file's preset that no longer exist are ignored: " + r.text("keys");
    }};

}  // namespace tureen::remarks
