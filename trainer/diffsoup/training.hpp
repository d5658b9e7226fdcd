// A whole training run, from photographs to a scene, for any program.
#pragma once

#include <functional>
#include <optional>

#include "scene/photographs.hpp"
#include "scene/region.hpp"
#include "scene/scene.hpp"
#include "trainer/common/whole_run.hpp"
#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/checkpoint.hpp"
#include "trainer/diffsoup/device.hpp"

namespace tureen::trainer {

/// The constants of a run in the units of the dataset, and those that `config` leaves to it: the
/// lattice level, the near zone without surfaces, and `far` behind the backing layer.
Config settled(const Config& config, const Dataset& dataset, const Region& region);

/// A run before its first step.
struct SoupStart {
  const Config& settled;
  const Backend& backend;
  std::size_t triangles = 0;
  bool is_visible = false;  // some training image shows a triangle
};

struct TrainingRequest {
  Config config;
  const Scene* start = nullptr;          // triangles or Gaussians, for Initialisation::mesh
  std::optional<Checkpoint> checkpoint;  // to continue from
  Device device = Device::automatic;
  RunRequest run;
  /// Makes the scene on which the first triangles of an automatic start lie; it may return none.
  /// May be empty. Its time is part of the run's.
  std::function<std::optional<Scene>(const Config& settled, const Region& region)> first_scene = {};
  /// Before the first step; may be empty, and may throw to end the run.
  std::function<void(const SoupStart&)> begun = {};
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
/// dataset (difference() in checkpoint.hpp); its configuration must be request.config, except
/// `steps` with minutes.
TrainingResult train(Dataset& dataset, TrainingRequest request);

}  // namespace tureen::trainer
