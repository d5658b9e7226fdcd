// The state of a run of splats, and its checkpoint: a run continues from it with the same bits.
// trainer/common/checkpoint_file.hpp has the format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/input.hpp"
#include "trainer/common/checkpoint_file.hpp"
#include "trainer/common/random.hpp"
#include "trainer/common/view_fingerprint.hpp"
#include "trainer/splats/gaussians/gaussian_config.hpp"
#include "trainer/splats/gaussians/gaussian_parameters.hpp"
#include "trainer/splats/neural/neural_config.hpp"
#include "trainer/splats/neural/neural_parameters.hpp"
#include "trainer/splats/splat_memory.hpp"
#include "trainer/splats/windows/window_config.hpp"
#include "trainer/splats/windows/window_parameters.hpp"

namespace tureen::trainer {

template <class Parameters>
struct SplatState {
  Parameters parameters = {};
  SplatMemory memory = {};
  Random random{0};
  int step = 0;                           // steps done
  std::vector<std::uint32_t> epoch = {};  // views that this epoch has yet to use, from the back
  std::uint64_t non_finite = 0;           // pixels and splats quarantined so far
};

template <class Config, class Parameters>
struct SplatCheckpoint {
  Config config;                       // `steps` as fitted so far
  std::vector<ViewFingerprint> views;  // training views, in their order
  double seconds = 0;                  // training time so far
  SplatState<Parameters> state;
};

using GaussianState = SplatState<GaussianParameters>;
using GaussianCheckpoint = SplatCheckpoint<GaussianConfig, GaussianParameters>;
using NeuralState = SplatState<NeuralParameters>;
using NeuralCheckpoint = SplatCheckpoint<NeuralConfig, NeuralParameters>;
using WindowState = SplatState<WindowParameters>;
using WindowCheckpoint = SplatCheckpoint<WindowConfig, WindowParameters>;

/// The functions below are for these three kinds of checkpoints.
template <class Checkpoint>
extern const CheckpointKind checkpoint_kind;

/// Writes the complete file or none. Throws OutputError.
template <class Config, class Parameters>
void write_checkpoint(const std::filesystem::path& path,
                      const SplatCheckpoint<Config, Parameters>& checkpoint);

/// Checks each count against the remaining bytes before it allocates memory. The result is
/// consistent: its arrays have the sizes that the number of splats and the degree need. Splats may
/// have numbers that are not finite, as in a run. Throws InputError.
template <class Checkpoint>
Checkpoint read_splat_checkpoint(Input input);

}  // namespace tureen::trainer
