// A run of any method, from its first step to the scene and its error in held-out views.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "scene/photographs.hpp"
#include "scene/scene.hpp"
#include "trainer/common/session.hpp"
#include "trainer/common/trainable.hpp"

namespace tureen::trainer {

struct RunRequest {
  std::string name;  // of the scene
  int threads = 0;   // 0: one per core
  /// The run sets `test_views`, `preview_camera` and `snapshot`, and values of a checkpoint.
  SessionOptions session;

  // Each of the following callbacks may be empty. A callback may throw to end the run.

  /// Progress, 0..1, of a method's work before the first step.
  std::function<void(double fraction)> preparing = {};
  /// Shows the scene before the first step, then every few seconds, and the finished scene.
  std::function<void(const Scene&)> snapshot = {};
  /// Stores the finished scene. If it throws, the run writes a checkpoint and then passes the error
  /// on.
  std::function<void(const Scene&)> finished = {};
  /// Progress, 0..1, while the trainer's own renderer draws the test views.
  std::function<void(double fraction)> measuring = {};
  /// Measures the finished scene, for example with the runtime (jobs/eval). Not called without test
  /// views.
  std::function<void(const Scene&)> evaluate = {};
};

struct RunResult {
  double seconds = 0;                       // all sessions of this run
  std::optional<double> test_psnr_db = {};  // drawn by the trainer; none without test views
};

/// Trains to the end, hands the scene to the callbacks, and measures dataset.test, if it has views.
/// `scene`: makes the layers of the current state; cameras and info are added. Throws OutputError
/// if a file of the session cannot be written, and any error from a callback.
RunResult run_to_the_end(Trainable& run, RunRequest request, const Dataset& dataset,
                         const std::function<Scene()>& scene);

}  // namespace tureen::trainer
