#include "cli/files/train_files.hpp"

#include <span>
#include <string>
#include <string_view>

#include "base/error.hpp"
#include "base/extension.hpp"
#include "base/input.hpp"
#include "cli/options/output_argument.hpp"
#include "trainer/common/run_control.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

/// Throws UsageError if `file` exists and is of another kind: the user may not have named it, and
/// training would replace it. A truncated file of the kind passes, because only its bytes are
/// compared with `beginning`.
void check_kind(const fs::path& file, std::string_view beginning, const char* kind) {
  std::error_code error;
  if (!fs::exists(file, error)) return;
  Input input = Input::open(file);
  std::string found(beginning.size(), '\0');
  found.resize(input.read_some(std::as_writable_bytes(std::span(found))));
  if (found != beginning.substr(0, found.size()))
    throw UsageError(file.string() + " exists and is not a " + kind, "choose another name");
}

void check_log(const TrainingFiles& files) {
  for (const fs::path& other : {files.scene, files.checkpoint, files.previews, files.lock,
                                files.watched, trainer::control_file(files.log)})
    if (files.log.lexically_normal() == other.lexically_normal())
      throw UsageError("--log cannot be " + other.string() + ", which is another output file");
  // Every line of a log begins like this, also a truncated line.
  check_kind(files.log, "{\"step\":", "training log");
}

}  // namespace

TrainingFiles training_files(const fs::path& scene) {
  if (extension_of(scene) != ".glb")
    throw UsageError("'" + scene.string() + "' does not end in .glb");
  const auto beside = [&](const char* extension) {
    return fs::path(scene).replace_extension(extension);
  };
  return {.scene = scene,
          .checkpoint = beside(".checkpoint"),
          .log = beside(".jsonl"),
          .previews = beside(".previews"),
          .lock = beside(".lock"),
          .watched = beside(".watch.glb"),
          .diffsoup_export = {}};
}

void check_writable(const TrainingFiles& files) {
  for (const fs::path& file : {files.scene, files.checkpoint, files.log})
    require_writable_file(file);
  check_log(files);
  const fs::path& folder = files.diffsoup_export;
  if (folder.empty()) return;
  for (const fs::path& other :
       {files.scene, files.checkpoint, files.log, files.previews, files.lock, files.watched})
    if (folder.lexically_normal() == other.lexically_normal())
      throw UsageError("--export-diffsoup cannot be " + other.string() +
                       ", which is another output file");
  require_writable_export(folder);
}

}  // namespace tureen::cli
