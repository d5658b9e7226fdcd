// The names of a training run's files, all beside its scene.
#pragma once

#include <filesystem>

namespace tureen::trainer {

struct TrainingFiles {
  std::filesystem::path scene;       // OUT.glb, OUT.ply or OUT.html
  std::filesystem::path checkpoint;  // OUT.checkpoint, until the run is complete
  std::filesystem::path log;         // OUT.jsonl
  std::filesystem::path previews;    // OUT.previews
  std::filesystem::path lock;        // OUT.lock, during the run
  std::filesystem::path watched;     // OUT.watch.glb, the scene for a window that follows the run
};

/// The files beside `scene`. Throws UsageError if it does not end in .glb, .ply
/// or .html.
TrainingFiles training_files(const std::filesystem::path& scene);

}  // namespace tureen::trainer
