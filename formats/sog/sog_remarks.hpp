// Remarks of the reader of SOG.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind level_chosen{"level_chosen", Severity::assumption,
                                         "The scene has {levels} levels of detail: level {level} "
                                         "with {splats} splats is read; level 0 is "
                                         "the finest, with {finest}",
                                         "lod"};

/// By ReadOptions::lod.
inline constexpr RemarkKind level_read{"level_read", Severity::note,
                                       "The scene has {levels} levels of detail: level {level} "
                                       "with {splats} splats is read"};

}  // namespace tureen::remarks
