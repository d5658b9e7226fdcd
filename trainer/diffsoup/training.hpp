// A whole training run, from photographs to a scene, for any program.
#pragma once

#include <functional>
#include <optional>

#include "scene/photographs.hpp"
#include "scene/scene.hpp"
#include "trainer/common/whole_run.hpp"
#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/checkpoint.hpp"
#include "trainer/diffsoup/device.hpp"

namespace tureen::trainer {

struct TrainingRequest {
  Config config;
  const Scene* start = nullptr;          // triangles or Gaussians, for Initialisation::mesh
  std::optional<Checkpoint> checkpoint;  // to continue from
  Device device = Device::automatic;
  RunRequest run;
  /// Before the first step; may be empty, and may throw to end the run. `visible`: some training
  /// image shows a triangle.
  std::function<void(const Backend&, bool visible)> begun = {};
};

struct TrainingResult {
  TrainingState state;
  RunResult run;
  bool visible_at_start = false;
  double opacity_binary_fraction = 0;  // fraction of texels with an alpha within 0.05 of 0 or 1
};

/// Trains on dataset.train and tests on dataset.test. train() frees the images of dataset.train.
/// Throws OutputError if a file of the session cannot be written, DeviceLimitError if the device
/// lacks memory, and any error from a callback. Asserts that a checkpoint has the views of the
/// dataset (difference() in checkpoint.hpp); its configuration must be request.config.
TrainingResult train(Dataset& dataset, TrainingRequest request);

}  // namespace tureen::trainer
