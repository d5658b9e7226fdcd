// A training run on disk: the exact state to resume from, with its configuration and views.
//
// The bytes: "TUREENTR", the version (u32), the configuration (as text of a --config file), the
// training views by name, size and checksums, the seconds so far, the state member by member, and
// last a CRC-32 of all before it. A count (u64) precedes texts and arrays. Numbers have the byte
// order of the machine, so a checkpoint needs a machine with the same byte order.
//
// The file does not contain the photographs. A version does not read checkpoints of other versions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "scene/photographs.hpp"
#include "trainer/diffsoup/config.hpp"
#include "trainer/diffsoup/state.hpp"

namespace tureen::trainer {

inline constexpr std::uint32_t checkpoint_version = 1;

/// Identifies a photograph and its camera.
struct ViewFingerprint {
  std::string name;
  std::int32_t width = 0, height = 0;
  std::uint32_t camera = 0;  // CRC-32 of the intrinsics and the pose
  std::uint32_t pixels = 0;  // CRC-32 of the RGBA bytes
};

std::vector<ViewFingerprint> fingerprint(std::span<const Photograph> photographs);

struct Checkpoint {
  Config config;                       // with training lengths, before scaled_to
  std::vector<ViewFingerprint> views;  // training views, in their order
  double seconds = 0;                  // training time so far
  TrainingState state;
};

/// Writes the complete file or none. Throws OutputError.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

/// Checks each count against the remaining bytes before it allocates memory. The result is
/// consistent: the state's arrays have the sizes that the configuration and the views need, and the
/// model is finite. Throws InputError.
Checkpoint read_checkpoint(Input& input);
Checkpoint read_checkpoint(const std::filesystem::path& path);

/// The first field that differs between a resumed run and its checkpoint, for example "steps is
/// 300, but the checkpoint has 40"; nothing if all are equal.
std::optional<std::string> difference(const Config& now, const Config& checkpoint);

/// The same for the training views: "train/r_3: the pixels differ from the checkpoint".
std::optional<std::string> difference(std::span<const ViewFingerprint> now,
                                      std::span<const ViewFingerprint> checkpoint);

}  // namespace tureen::trainer
