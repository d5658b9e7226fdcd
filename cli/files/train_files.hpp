// The files of a training run: what is written beside OUT.glb, and whether it can be.
#pragma once

#include <filesystem>
#include <string>

namespace tureen::cli {

struct TrainingFiles {
  std::filesystem::path scene;            // OUT.glb
  std::filesystem::path checkpoint;       // OUT.checkpoint, until the run is done
  std::filesystem::path log;              // OUT.jsonl
  std::filesystem::path previews;         // OUT.previews
  std::filesystem::path lock;             // OUT.lock, while the run goes on
  std::filesystem::path diffsoup_export;  // empty: none
};

/// The names beside `scene`. Throws UsageError where that does not end in .glb.
TrainingFiles training_files(const std::filesystem::path& scene);

/// Hours may pass until the files are written, so each is tried before: a temporary file in its
/// folder, which goes again. Throws OutputError; UsageError where something other than a DiffSoup
/// export stands where the export is to be.
void check_writable(const TrainingFiles& files);

}  // namespace tureen::cli
