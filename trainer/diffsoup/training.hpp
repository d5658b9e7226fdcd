// A whole training run, from photographs to a scene, for any program.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "scene/photographs.hpp"
#include "scene/scene.hpp"
#include "trainer/common/session.hpp"
#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/checkpoint.hpp"
#include "trainer/diffsoup/device.hpp"

namespace tureen::trainer {

struct TrainingRequest {
  Config config;
  std::string name;                      // of the scene
  const Scene* mesh = nullptr;           // initial triangles, for Initialisation::mesh
  std::optional<Checkpoint> checkpoint;  // to continue from
  Device device = Device::automatic;
  int threads = 0;         // 0: one per core
  SessionOptions session;  // train() sets `test_views`, `seconds_before` and `snapshot`

  // Each of the following callbacks may be empty. A callback may throw to end the run.

  /// Before the first step. `visible`: some training image shows a triangle.
  std::function<void(const Backend&, bool visible)> begun = {};
  /// Shows the scene before the first step, then every few seconds, and the finished scene.
  std::function<void(const Scene&)> snapshot = {};
  /// Stores the finished scene. If it throws, train() writes a checkpoint and then passes the error
  /// on.
  std::function<void(const Scene&)> finished = {};
  /// Progress, 0..1, while the trainer's own renderer draws the test views.
  std::function<void(double fraction)> measuring = {};
  /// Measures the finished scene, for example with the runtime (jobs/eval).
  std::function<void(const Scene&)> evaluate = {};
};

struct TrainingResult {
  TrainingState state;
  bool visible_at_start = false;
  double seconds = 0;                  // all sessions of this run
  double test_psnr_db = 0;             // drawn by the trainer
  double opacity_binary_fraction = 0;  // fraction of texels with an alpha within 0.05 of 0 or 1
};

/// Trains on dataset.train and tests on dataset.test. train() frees the images of dataset.train.
/// Throws OutputError if a file of `session` cannot be written, DeviceLimitError if the device
/// lacks memory, and any error from a callback. Asserts that a checkpoint has the views of the
/// dataset (difference() in checkpoint.hpp); its configuration must be request.config.
TrainingResult train(Dataset& dataset, TrainingRequest request);

}  // namespace tureen::trainer
