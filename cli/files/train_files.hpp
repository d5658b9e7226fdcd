// The files of a training run beside OUT.glb, and checks that they can be written.
#pragma once

#include <filesystem>
#include <string>

namespace tureen::cli {

struct TrainingFiles {
  std::filesystem::path scene;            // OUT.glb
  std::filesystem::path checkpoint;       // OUT.checkpoint, until the run is complete
  std::filesystem::path log;              // OUT.jsonl
  std::filesystem::path previews;         // OUT.previews
  std::filesystem::path lock;             // OUT.lock, during the run
  std::filesystem::path watched;          // OUT.watch.glb, with --watch
  std::filesystem::path diffsoup_export;  // empty: none
};

/// The file names beside `scene`. Throws UsageError if it does not end in .glb.
TrainingFiles training_files(const std::filesystem::path& scene);

/// Checks each file with a temporary file in its folder, because training takes hours until the
/// files are written. Throws OutputError. Throws UsageError if two outputs have the same path, or
/// if another kind of file exists at the path of the log or the export.
void check_writable(const TrainingFiles& files);

}  // namespace tureen::cli
