// Identifies the training views of a run, so that it resumes only with the same photographs.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/photographs.hpp"

namespace tureen::trainer {

/// Identifies a photograph and its camera.
struct ViewFingerprint {
  std::string name;
  std::int32_t width = 0, height = 0;
  std::uint32_t camera = 0;  // CRC-32 of the intrinsics and the pose
  std::uint32_t pixels = 0;  // CRC-32 of the RGBA bytes and the mask
};

std::vector<ViewFingerprint> fingerprint(std::span<const Photograph> photographs);

/// The first difference between a resumed run and its checkpoint: "train/r_3: the pixels differ
/// from the checkpoint"; nothing if all are equal.
std::optional<std::string> difference(std::span<const ViewFingerprint> now,
                                      std::span<const ViewFingerprint> checkpoint);

/// The first view with an invalid size; nothing if all are valid.
std::optional<std::string> defect(std::span<const ViewFingerprint> views);

}  // namespace tureen::trainer
