// The state of a run of Gaussians, and its checkpoint: a run continues from it with the same bits.
// trainer/common/checkpoint_file.hpp has the format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "trainer/common/random.hpp"
#include "trainer/common/view_fingerprint.hpp"
#include "trainer/splats/gaussian_config.hpp"
#include "trainer/splats/gaussian_step_kernels.hpp"

namespace tureen::trainer {

struct GaussianState {
  GaussianParameters parameters = {};
  SplatMemory memory = {};
  Random random{0};
  int step = 0;                           // steps done
  std::vector<std::uint32_t> epoch = {};  // views that this epoch has yet to use, from the back
  std::uint64_t non_finite = 0;           // pixels and splats quarantined so far
  int fits = 0;                           // how often the steps were fitted to the minutes
};

inline constexpr std::uint32_t gaussian_checkpoint_version = 1;

struct GaussianCheckpoint {
  GaussianConfig config;               // `steps` as fitted so far
  std::vector<ViewFingerprint> views;  // training views, in their order
  double seconds = 0;                  // training time so far
  GaussianState state;
};

/// Writes the complete file or none. Throws OutputError.
void write_checkpoint(const std::filesystem::path& path, const GaussianCheckpoint& checkpoint);

/// Checks each count against the remaining bytes before it allocates memory. The result is
/// consistent: its arrays have the sizes that the number of splats and the degree need. Splats may
/// have numbers that are not finite, as in a run. Throws InputError.
GaussianCheckpoint read_gaussian_checkpoint(Input& input);
GaussianCheckpoint read_gaussian_checkpoint(const std::filesystem::path& path);

}  // namespace tureen::trainer
