// A training run of soups on disk: the exact state to resume from, with its configuration and
// views. trainer/common/checkpoint_file.hpp has the format.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "trainer/common/view_fingerprint.hpp"
#include "trainer/diffsoup/config.hpp"
#include "trainer/diffsoup/state.hpp"

namespace tureen::trainer {

/// The first bytes of a checkpoint, and its version.
inline constexpr std::array<char, 8> diffsoup_magic{'T', 'U', 'R', 'E', 'E', 'N', 'T', 'R'};
inline constexpr std::uint32_t checkpoint_version = 2;

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
Checkpoint read_checkpoint(Input input);

/// The first field that differs between a resumed run and its checkpoint, for example "steps is
/// 300, but the checkpoint has 40"; nothing if all are equal. With minutes, the steps may differ.
std::optional<std::string> difference(const Config& now, const Config& checkpoint);

}  // namespace tureen::trainer
