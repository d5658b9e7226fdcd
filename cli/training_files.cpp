#include "cli/training_files.hpp"

#include <array>
#include <span>
#include <string_view>

#include "cli/output_argument.hpp"
#include "formats/input.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

/// A log is begun anew, so what is there must be one, or nothing: not a scene, not a dataset.
void check_log(const TrainingFiles& files) {
  std::error_code error;
  for (const fs::path& other :
       {files.scene, files.checkpoint, files.plot, files.previews, files.lock})
    if (files.log.lexically_normal() == other.lexically_normal())
      throw UsageError("the log cannot be " + other.string() + ", which is written, too");
  if (!fs::exists(files.log, error)) return;
  // All lines of a log begin so, also one that was cut short.
  constexpr std::string_view beginning = "{\"step\":";
  Input log = Input::open(files.log);
  std::array<char, beginning.size()> found{};
  const std::size_t size = log.read_some(std::as_writable_bytes(std::span(found)));
  if (std::string_view(found.data(), size) != beginning.substr(0, size))
    throw UsageError(files.log.string() + " exists and is no log of training; choose another name");
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
          .lock = beside(".lock"),
          .diffsoup_export = {}};
}

void check_writable(const TrainingFiles& files) {
  for (const fs::path& file : {files.scene, files.checkpoint, files.log, files.plot})
    require_writable_file(file);
  check_log(files);
  const fs::path& folder = files.diffsoup_export;
  if (folder.empty()) return;
  for (const fs::path& other :
       {files.scene, files.checkpoint, files.log, files.plot, files.previews, files.lock})
    if (folder.lexically_normal() == other.lexically_normal())
      throw UsageError("the export cannot be " + other.string() + ", which is written, too");
  require_writable_export(folder);
}

}  // namespace tureen::cli
