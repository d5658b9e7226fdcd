#include "trainer/common/training_files.hpp"

#include "base/error.hpp"
#include "base/extension.hpp"

namespace tureen::trainer {

TrainingFiles training_files(const std::filesystem::path& scene) {
  const std::string format = extension_of(scene);
  if (format != ".glb" && format != ".ply" && format != ".html")
    throw UsageError("'" + scene.string() + "' does not end in .glb, .ply or .html",
                     "tureen convert writes the other formats from a .glb");
  const auto beside = [&](const char* extension) {
    return std::filesystem::path(scene).replace_extension(extension);
  };
  return {.scene = scene,
          .checkpoint = beside(".checkpoint"),
          .log = beside(".jsonl"),
          .previews = beside(".previews"),
          .lock = beside(".lock"),
          .watched = beside(".watch.glb")};
}

}  // namespace tureen::trainer
