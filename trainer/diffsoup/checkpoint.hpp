// A training run on disk: everything that going on needs, bit by bit, and what it belongs to.
//
// The bytes: "TUREENTR", the version (u32), the configuration (as a --config file holds it), the
// training views by name, size and checksums, the seconds so far, the state member by member, and
// last a CRC-32 of all before it. Texts and arrays have their count before them (u64); numbers lie
// as they do in memory, so a checkpoint is for machines of the same byte order.
//
// What it does not do: it does not hold the photographs, and no version reads another's.
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

/// What a photograph is known by.
struct ViewFingerprint {
  std::string name;
  std::int32_t width = 0, height = 0;
  std::uint32_t camera = 0;  // CRC-32 of the intrinsics and the pose
  std::uint32_t pixels = 0;  // CRC-32 of the RGBA bytes
};

std::vector<ViewFingerprint> fingerprint(std::span<const Photograph> photographs);

struct Checkpoint {
  Config config;                       // with lengths of training, before scaled_to
  std::vector<ViewFingerprint> views;  // trained on, in their order
  double seconds = 0;                  // of training so far
  TrainingState state;
};

/// The file appears whole or not at all. Throws OutputError.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

/// Every count is checked against the bytes that are there before anything is allocated. The state
/// belongs to the configuration and the views: its arrays have their sizes, its model is finite.
/// Throws InputError.
Checkpoint read_checkpoint(Input& input);
Checkpoint read_checkpoint(const std::filesystem::path& path);

/// The first field in which a run that goes on differs from the one that was left, as in
/// "steps is 300, the checkpoint's 40"; nothing where there is none.
std::optional<std::string> difference(const Config& now, const Config& checkpoint);

/// Likewise of the training views: "train/r_3: other pixels than the checkpoint's".
std::optional<std::string> difference(std::span<const ViewFingerprint> now,
                                      std::span<const ViewFingerprint> checkpoint);

}  // namespace tureen::trainer
