#include "cli/training_files.hpp"

#include "formats/diffsoup_export.hpp"
#include "formats/output.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

void try_to_write(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error))
    throw OutputError({file.string(), {}, {}}, "cannot be written: it is a folder");
  const Output probe(file);  // removes its temporary file
}

}  // namespace

TrainingFiles training_files(const fs::path& scene) {
  if (scene.extension() != ".glb")
    throw UsageError("'" + scene.string() + "' does not end in .glb, which is what is written");
  const auto beside = [&](const char* extension) {
    return fs::path(scene).replace_extension(extension);
  };
  return {.scene = scene,
          .checkpoint = beside(".checkpoint"),
          .log = beside(".jsonl"),
          .plot = beside(".svg"),
          .previews = beside(".previews"),
          .diffsoup_export = {}};
}

void check_writable(const TrainingFiles& files) {
  for (const fs::path& file : {files.scene, files.checkpoint, files.log, files.plot})
    try_to_write(file);
  const fs::path& folder = files.diffsoup_export;
  if (folder.empty()) return;
  std::error_code error;
  if (!fs::exists(folder, error)) {
    try_to_write(folder);
  } else if (!is_diffsoup_export(folder) &&
             !(fs::is_directory(folder, error) && fs::is_empty(folder, error))) {
    throw UsageError(folder.string() + " exists and is no DiffSoup export; choose another name");
  }
}

}  // namespace tureen::cli
