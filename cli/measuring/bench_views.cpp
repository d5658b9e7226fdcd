#include "cli/measuring/bench_views.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "camera/camera_sets.hpp"
#include "cli/options/dataset_argument.hpp"
#include "cli/options/values.hpp"
#include "cli/options/view_options.hpp"
#include "cli/report.hpp"

namespace tureen::cli {

namespace {

constexpr const char* sweep_sizes[] = {"640x360", "1280x720", "1920x1080", "2560x1440",
                                       "3840x2160"};
constexpr const char* fractions[] = {"full", "half", "quarter"};

/// A word of --cameras, parsed.
struct CameraSet {
  enum class Kind { hemisphere, orbit, adversarial, dataset, file };
  Kind kind = Kind::file;
  int count = 0;     // views of hemisphere and orbit
  std::string name;  // for the result

  bool recorded() const { return kind == Kind::dataset || kind == Kind::file; }
};

CameraSet parse_set(const std::string& text) {
  if (const auto set = parse_camera_set(text, {"hemisphere", "orbit"}))
    return {.kind = set->kind == "orbit" ? CameraSet::Kind::orbit : CameraSet::Kind::hemisphere,
            .count = set->count,
            .name = set->text()};
  if (text == "adversarial") return {.kind = CameraSet::Kind::adversarial, .name = text};
  if (text == "dataset") return {.kind = CameraSet::Kind::dataset, .name = text};
  return {.kind = CameraSet::Kind::file, .name = text};
}

std::vector<CameraSet> sets_of(const BenchViewOptions& options) {
  if (options.cameras.empty())
    return {parse_set(options.dataset.empty() ? "hemisphere" : "dataset")};
  std::vector<CameraSet> sets;
  for (const std::string& text : options.cameras) sets.push_back(parse_set(text));
  return sets;
}

int divisor(const std::string& size) {
  const auto found = std::find(std::begin(fractions), std::end(fractions), size);
  return found == std::end(fractions) ? 0 : 1 << (found - std::begin(fractions));
}

/// The sizes in the options; empty: the default size of each set.
std::vector<std::string> sizes_of(const BenchViewOptions& options) {
  std::vector<std::string> sizes = options.sizes;
  if (options.sweep) {
    sizes.insert(sizes.end(), std::begin(sweep_sizes), std::end(sweep_sizes));
    sizes.insert(sizes.end(), std::begin(fractions), std::end(fractions));
  }
  return sizes;
}

Camera divided(const Camera& camera, int by) {
  if (by == 1) return camera;
  return resized(camera, std::max(camera.width / by, 1), std::max(camera.height / by, 1));
}

std::vector<Camera> dataset_cameras(const std::string& path, std::vector<std::string>& notes) {
  DatasetArgument argument;
  argument.path = path;
  const Dataset dataset = read(argument, DatasetPart::test);
  for (std::string& note : notes_of(dataset.remarks)) notes.push_back(std::move(note));
  std::vector<Camera> cameras;
  for (const Photograph& photograph : dataset.test) cameras.push_back(photograph.camera);
  return cameras;
}

/// A set at any size: recorded and adversarial cameras are resized; the others are framed for the
/// size.
class SetAtSizes {
 public:
  SetAtSizes(const CameraSet& set, const BenchViewOptions& options, const Scene& scene,
             const std::string& scene_path, std::vector<std::string>& notes)
      : set_(set), subject_(subject_of(scene)) {
    if (set.kind == CameraSet::Kind::dataset) {
      fixed_ = dataset_cameras(options.dataset, notes);
    } else if (set.kind == CameraSet::Kind::file) {
      Views views = recorded_views(set.name, "all", scene, scene_path);
      fixed_ = std::move(views.cameras);
      notes.insert(notes.end(), views.notes.begin(), views.notes.end());
    } else if (set.kind == CameraSet::Kind::adversarial) {
      if (splat_count(scene) > 0) throw UsageError("--cameras adversarial needs triangles");
      // Chosen once, so that all sizes have the same views.
      fixed_ = adversarial_views(only_soup(scene), origin_of(only_layer(scene)), subject_, Lens{});
    }
  }

  std::vector<Camera> at(const std::string& size) const {
    std::vector<Camera> cameras = fixed_;
    if (const int by = divisor(size)) {
      for (Camera& camera : cameras) camera = divided(camera, by);
      return cameras;
    }
    const ImageSize pixels = parse_size(size);
    for (Camera& camera : cameras) camera = resized(camera, pixels.width, pixels.height);
    if (!cameras.empty()) return cameras;
    const Lens lens{.width = pixels.width, .height = pixels.height};
    return set_.kind == CameraSet::Kind::orbit
               ? orbit(subject_, set_.count, {0.0, orbit_elevation}, lens)
               : hemisphere(subject_, set_.count, lens);
  }

 private:
  const CameraSet& set_;
  Subject subject_;
  std::vector<Camera> fixed_;  // of recorded and adversarial views
};

double pixels_of(const BenchViews& views) {
  double sum = 0;
  for (const Camera& camera : views.cameras) sum += double(camera.width) * camera.height;
  return sum / double(views.cameras.size());
}

}  // namespace

void add_bench_view_options(Command& command, BenchViewOptions& options) {
  command.add_option(
      "DATASET", options.dataset,
      "posed photographs, as for tureen eval; the scene is drawn from their test cameras");
  command
      .add_option("--cameras SET,..", options.cameras,
                  "sets of views, separated by commas: hemisphere[:N] (evenly spaced above the "
                  "scene), orbit[:N], adversarial (inside, far, grazing, most overdraw), dataset, "
                  "or a FILE[:N] with cameras as for tureen render --camera; dataset by default if "
                  "DATASET is given, else hemisphere:8")
      .comma_list();
  command
      .add_option(
          "--size,--sizes WxH,..", options.sizes,
          "image sizes, separated by commas: WxH in pixels; recorded cameras also support full, "
          "half and quarter of their own size; default: full for recorded cameras, else 1280x720")
      .comma_list();
  command.add_flag("--sweep", options.sweep,
                   "use the sizes 640x360, 1280x720, 1920x1080, 2560x1440 and 3840x2160; for "
                   "recorded cameras also full, half and quarter");
}

void check(const BenchViewOptions& options) {
  const std::vector<CameraSet> sets = sets_of(options);
  const bool recorded =
      std::any_of(sets.begin(), sets.end(), [](const CameraSet& set) { return set.recorded(); });
  for (const std::string& size : options.sizes) {
    if (!divisor(size)) parse_size(size);
    if (divisor(size) && !recorded)
      throw UsageError("'" + size + "' needs recorded cameras: a DATASET, or a file in --cameras");
  }
  for (const CameraSet& set : sets) {
    if (set.kind == CameraSet::Kind::dataset && options.dataset.empty())
      throw UsageError("--cameras dataset needs a DATASET after the scene");
    // A file may have any name, but a missing file is probably a mistyped word.
    const std::string file = set.name.substr(0, set.name.rfind(':'));
    if (set.kind == CameraSet::Kind::file && is_missing(set.name) && is_missing(file))
      throw UsageError(
          "--cameras takes hemisphere[:N], orbit[:N], adversarial, dataset or a file with cameras, "
          "not '" +
          set.name + "', which does not exist");
  }
}

BenchViewList bench_views(const BenchViewOptions& options, const Scene& scene,
                          const std::string& scene_path) {
  BenchViewList result;
  const std::vector<CameraSet> sets = sets_of(options);
  for (const CameraSet& set : sets) {
    const SetAtSizes cameras(set, options, scene, scene_path, result.notes);
    std::vector<std::string> sizes = sizes_of(options);
    if (sizes.empty()) sizes = {set.recorded() ? "full" : "1280x720"};
    for (const std::string& size : sizes)
      if (!divisor(size) || set.recorded())
        result.views.push_back({set.name, size, cameras.at(size)});
  }
  std::stable_sort(
      result.views.begin(), result.views.end(),
      [](const BenchViews& a, const BenchViews& b) { return pixels_of(a) < pixels_of(b); });
  return result;
}

}  // namespace tureen::cli
