// A whole training run of splats, from photographs to a scene, for any program.
#pragma once

#include <functional>
#include <optional>

#include "scene/photographs.hpp"
#include "scene/region.hpp"
#include "scene/scene.hpp"
#include "trainer/common/whole_run.hpp"
#include "trainer/splats/splat_state.hpp"

namespace tureen::trainer {

/// A run before its first step.
struct SplatStart {
  std::size_t splats = 0;
  int threads = 0;
};

template <class Config, class Parameters>
struct SplatRequest {
  Config config;
  const Scene* start = nullptr;                                   // for Initialisation::mesh
  std::optional<SplatCheckpoint<Config, Parameters>> checkpoint;  // to continue from
  RunRequest run;
  /// A scene to begin with, as `start`; its time is a part of the run's. Called for a new run
  /// without `start`. May be empty, and may return none.
  std::function<std::optional<Scene>(const Region&)> first_scene = {};
  /// Called before the first step. May be empty, and may throw to end the run.
  std::function<void(const SplatStart&)> begun = {};
};

using GaussianRequest = SplatRequest<GaussianConfig, GaussianParameters>;
using NeuralRequest = SplatRequest<NeuralConfig, NeuralParameters>;
using WindowRequest = SplatRequest<WindowConfig, WindowParameters>;

struct SplatResult {
  RunResult run;
  int steps = 0;
  PrimitiveCount primitives;     // of the scene
  std::uint64_t non_finite = 0;  // pixels and splats quarantined
};

/// Trains on dataset.train and tests on dataset.test; frees the images of dataset.train. The scene
/// has one layer, at the centre of the region of interest, with the primitives of the method
/// (primitives() of GaussianTraining and others). With config.minutes, the number of
/// steps is fitted to the time (trainer/common/session_timers.hpp). Throws the errors of
/// region_of_interest, initial_splats and run_to_the_end. Asserts that a checkpoint has the views
/// of the dataset; its configuration must be request.config, except `steps` with minutes.
template <class Config, class Parameters>
SplatResult train_splats(Dataset& dataset, SplatRequest<Config, Parameters> request);

}  // namespace tureen::trainer
