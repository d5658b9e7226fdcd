// Remarks of the reader of DiffSoup exports.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind alpha_half_restored{
    "alpha_half_restored", Severity::assumption,
    "{texels} of {all} texels have an alpha byte of 127, and hardly any have 126 or 128: 127 is "
    "assumed to be a truncated 1/2 and becomes 128, so that they are drawn as in training"};
inline constexpr RemarkKind meta_missing{
    "meta_missing", Severity::assumption,
    "meta.json is missing: level 5, up -y and a black background are assumed"};
inline constexpr RemarkKind level_missing{"level_missing", Severity::assumption,
                                          "meta.json has no level: 5 is assumed"};

}  // namespace tureen::remarks
