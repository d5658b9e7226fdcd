#include "cli/tradeoff/tradeoff_write.hpp"

#include <utility>

#include "base/error.hpp"
#include "base/extension.hpp"
#include "cli/options/output_argument.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "formats/scene_file.hpp"

namespace tureen::cli {

namespace fs = std::filesystem;

void require_writable_scene(const fs::path& path, const fs::path& scene, bool replaces) {
  if (extension_of(path) != ".glb")
    throw UsageError("'" + path.string() + "' does not end in .glb; --write writes GLB files");
  std::error_code error;
  if (fs::equivalent(path, scene, error))
    throw UsageError(path.string() + " is also the input SCENE", "choose another name");
  if (fs::exists(path, error) && !replaces)
    throw UsageError(path.string() + " exists", "choose another name, or replace it with --force");
  require_writable_file(path);
}

void write_chosen(const fs::path& path, Scene scene, TradeoffReport& report) {
  if (!report.study.choice) return;
  const tradeoff::Applied& applied = report.study.drawing.outcomes[*report.study.choice].applied;
  std::vector<std::string> sentences;
  if (!has_edits(applied)) {
    sentences.emplace_back("without edits: no edit within the limits is measurably faster");
  } else {
    Progress progress("reducing the scene");
    scene = edited(std::move(scene), applied, [&](double done) { progress.update(done); });
    scene.info.notes.push_back("reduced by tureen tradeoff: " + describe_edits(applied));
  }
  if (splat_count(scene) > 0) scene.quality.splat_order = applied.quality.splat_order;
  const std::vector<std::string> losses = write_scene(scene, path);
  sentences.insert(sentences.end(), losses.begin(), losses.end());
  say_list("Writing " + path.string() + ":", sentences);
  report.scene_written = path.string();
  report.output.push_back(path.string());
}

}  // namespace tureen::cli
