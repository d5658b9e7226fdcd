// Remarks of the reader of PyTorch checkpoints.
#pragma once

#include "scene/remark.hpp"

namespace tureen::remarks {

inline constexpr RemarkKind up_unknown_to_checkpoint{
    "up_unknown_to_checkpoint", Severity::assumption,
    "the checkpoint stores no up axis: -y is assumed, as in COLMAP; scenes trained on Blender "
    "images have +z",
    "up"};
inline constexpr RemarkKind up_of_colmap_scene{
    "up_of_colmap_scene", Severity::assumption,
    "the checkpoint has flip_z: a COLMAP scene is assumed, with up -y and a black background"};
inline constexpr RemarkKind up_of_synthetic_scene{"up_of_synthetic_scene", Severity::assumption,
                                                  "the checkpoint has no flip_z: a synthetic scene "
                                                  "is assumed, with up +z and a white background"};

}  // namespace tureen::remarks
