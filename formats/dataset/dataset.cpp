#include "formats/dataset/dataset.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <set>

#include "base/platform/scratch_file.hpp"
#include "formats/dataset/alpha.hpp"
#include "formats/dataset/bundler.hpp"
#include "formats/dataset/colmap.hpp"
#include "formats/dataset/dataset_outline.hpp"
#include "formats/dataset/dataset_remarks.hpp"
#include "formats/dataset/photograph.hpp"
#include "formats/dataset/skipped.hpp"
#include "image/codecs/exif.hpp"
#include "image/png.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

/// Rejects a part without photographs. All of a dataset may have no test views.
void require_photographs(const DatasetOutline& outline, const DatasetOptions& options) {
  const auto refuse = [&](const Frames& frames, bool needed, const char* what) {
    if (needed && frames.empty())
      throw InputError({outline.file}, std::string("there are no photographs to ") + what + ": " +
                                           std::to_string(outline.train.size()) + " to train on, " +
                                           std::to_string(outline.test.size()) + " to test");
  };
  refuse(outline.train, options.part != DatasetPart::test, "train on");
  refuse(outline.test, options.part == DatasetPart::test, "test");
}

/// The way out where the folder of temporary files is full or cannot be written.
constexpr const char* scratch_hint =
    "TMPDIR names another folder, --max-memory SIZE keeps more in memory, and --scale makes "
    "photographs smaller";

/// Holds the pixels of photographs in memory up to half of the budget, because their decoders need
/// memory, too, and those of further ones in a file.
class PixelStore {
 public:
  explicit PixelStore(const MemoryBudget& budget) : budget_(budget), left_(budget.left() / 2) {}

  /// Rejects a photograph that exceeds the budget, and photographs that exceed the disk, before
  /// they are decoded, which may take minutes. Possible only if the dataset stores their sizes.
  void require_space(const std::vector<const DatasetFrame*>& frames,
                     const DatasetOptions& options) {
    double pixels = 0;
    for (const DatasetFrame* frame : frames)
      if (frame->size) {
        const double size =
            double(scaled_side(frame->size->x, options.scale / options.images_folder)) *
            scaled_side(frame->size->y, options.scale / options.images_folder);
        // Cropping removes less than half of the pixels.
        if (0.5 * sizeof(glm::u8vec4) * size > double(budget_.left()))
          throw InputError({frame->name}, budget_.refusal("the photograph"),
                           std::string(max_memory_hint) + ", --scale makes it smaller");
        pixels += size;
      }
    // In the file, opaque pixels have three bytes.
    const double bytes = 0.5 * 3 * pixels - double(left_);
    if (bytes <= 0) return;
    with_hint([&] { file_ = std::make_shared<ScratchFile>(); });
    std::error_code unknown;
    const fs::space_info space = fs::space(scratch_folder(), unknown);
    if (!unknown && bytes > double(space.available))
      throw OutputError({scratch_folder().string()},
                        "the photographs need at least " + memory_size_text(std::uint64_t(bytes)) +
                            " in a temporary file, but the disk has " +
                            memory_size_text(space.available),
                        scratch_hint);
  }

  /// `photograph`: its memory is charged to the budget.
  void keep(Photograph& photograph) {
    const std::uint64_t bytes = photograph.bytes();
    if (bytes <= left_) {
      left_ -= bytes;
      return;
    }
    with_hint([&] {
      if (!file_) file_ = std::make_shared<ScratchFile>();
      photograph.move_to(file_);
    });
    budget_.give_back(bytes);
  }

 private:
  static void with_hint(const auto& act) {
    try {
      act();
    } catch (const OutputError& error) {
      throw OutputError(error.position(), error.reason(), scratch_hint);
    }
  }

  MemoryBudget budget_;
  std::uint64_t left_;
  std::shared_ptr<ScratchFile> file_;
};

/// Between the left and the right edge, in degrees.
double angle_of_view(const Camera& camera) {
  return glm::degrees(std::atan(camera.cx / camera.fx) +
                      std::atan((camera.width - camera.cx) / camera.fx));
}

/// The frames of the requested part that can be used, train first, and their files.
struct FoundDataset {
  DatasetOutline outline;
  std::vector<const DatasetFrame*> frames = {};  // in `outline`
  std::vector<FoundPhotograph> files = {};
  SkippedPhotographs skipped = {};
};

/// Finds the files of a part, and removes the frames without.
class FileSearch {
 public:
  FileSearch(FoundDataset& found, const DatasetOptions& options)
      : found_(found), is_strict_(options.is_strict) {}

  void take(Frames& frames) {
    std::map<fs::path, std::set<std::string>> uses;  // a panorama has six views
    std::vector<std::optional<NearFiles::Found>> images;
    for (const DatasetFrame& frame : frames) {
      images.push_back(frame.defect.empty() ? find_image(frame, found_.outline.images_folder, near_)
                                            : std::nullopt);
      if (images.back()) uses[images.back()->path].insert(frame.file);
    }
    Frames kept;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      DatasetFrame& frame = frames[i];
      // Two photographs cannot be one file that is near to both names.
      if (images[i] && !images[i]->is_exact && uses[images[i]->path].size() > 1) images[i].reset();
      if (frame.defect.empty() && !images[i]) frame.defect = missing(frame);
      FoundPhotograph files;
      if (frame.defect.empty()) try {
          files = {images[i]->path, find_mask(frame, found_.outline.images_folder, near_)};
        } catch (const InputError& error) {
          if (is_strict_) throw;
          frame.defect = error.reason() + ": " + error.position().file;
        }
      if (!frame.defect.empty()) {
        found_.skipped.add(frame.name, frame.defect);
        continue;
      }
      if (!images[i]->is_exact && renamed_++ == 0)
        first_renamed_ = {frame.name, files.image.string()};
      found_.files.push_back(std::move(files));
      kept.push_back(std::move(frame));
    }
    frames = std::move(kept);
  }

  void add_remarks(std::vector<Remark>& list) const {
    if (renamed_ > 0)
      list.push_back({&remarks::photographs_renamed,
                      {{"count", std::uint64_t(renamed_)},
                       {"name", first_renamed_.first},
                       {"file", first_renamed_.second}}});
  }

 private:
  std::string missing(const DatasetFrame& frame) {
    const std::string folder = frame.folder.empty() ? "." : frame.folder.string();
    std::string reason = "the file is missing in " + folder;
    // One name is an example for all; a search for each of thousands would take minutes.
    if (nearest_.empty()) nearest_ = near_.nearest(frame.folder, frame.file);
    if (!nearest_.empty()) reason += ", whose most similar name is " + nearest_;
    return reason;
  }

  FoundDataset& found_;
  NearFiles near_;
  bool is_strict_;
  std::size_t renamed_ = 0;
  std::pair<std::string, std::string> first_renamed_;
  std::string nearest_;
};

FoundDataset find_dataset(const fs::path& path, const DatasetOptions& options,
                          const MemoryBudget& budget) {
  FoundDataset found{.outline = read_outline(path, options, budget)};
  DatasetOutline& outline = found.outline;
  require_photographs(outline, options);
  if (options.part == DatasetPart::test) outline.train.clear();
  if (options.part == DatasetPart::train) outline.test.clear();
  FileSearch search(found, options);
  search.take(outline.train);
  const SkippedPhotographs of_train = found.skipped;
  const std::size_t tests = outline.test.size();
  search.take(outline.test);
  // BlenderNeRF writes the file with the test views, but does not render them.
  if (outline.has_own_test && options.part == DatasetPart::all && tests > 0 &&
      outline.test.empty() && !options.is_strict) {
    found.skipped = of_train;
    outline.dataset.remarks.push_back({&remarks::split_without_test, {{"count", tests}}});
  }
  search.add_remarks(outline.dataset.remarks);
  found.skipped.require_enough(outline.file, found.files.size(), options.is_strict);
  require_photographs(outline, options);
  // Moving a vector keeps the addresses of its elements.
  for (const DatasetFrame& frame : outline.train) found.frames.push_back(&frame);
  for (const DatasetFrame& frame : outline.test) found.frames.push_back(&frame);
  return found;
}

LensKind kind_of(const Lens& lens) {
  if (lens.is_fisheye()) return LensKind::fisheye;
  return lens.is_pinhole() ? LensKind::pinhole : LensKind::distorted;
}

/// The camera of the image as it is stored.
Camera stored_camera(const DatasetFrame& frame, const fs::path& image, int images_folder,
                     const MemoryBudget& budget, std::optional<glm::ivec2>& common_size) {
  glm::ivec2 size = frame.size.value_or(common_size.value_or(glm::ivec2(0)));
  if (size.x == 0) {
    PassingMemory passing(budget);
    Input input = Input::open(image, budget);
    const Image8 pixels = read_image(input);
    size = glm::ivec2(pixels.width, pixels.height) * images_folder;
    if (!frame.any_size) common_size = size;
  }
  Camera camera = frame.camera(size.x, size.y);
  if (images_folder > 1)
    camera = resampled(camera, scaled_side(camera.width, 1.0 / images_folder),
                       scaled_side(camera.height, 1.0 / images_folder));
  camera.name = frame.name;
  return camera;
}

/// What read_dataset() has seen while it read the photographs.
struct Observed {
  bool distorted = false;
  double widest_fisheye = 0;  // between the left and the right edge, in degrees
  int lost_columns = 0, lost_rows = 0;
  int shrunk = 1;
  std::uint64_t turned = 0, with_orientation = 0;
  glm::dvec3 up{0};  // sum of the photographs' up axes, as viewers show them

  void add(const DatasetFrame& frame, const ReadPhotograph& read) {
    if (frame.lens.is_fisheye())
      widest_fisheye = std::max(widest_fisheye, angle_of_view(read.photograph.camera));
    else
      distorted = distorted || !frame.lens.is_pinhole();
    lost_columns = std::max(lost_columns, read.lost_columns);
    lost_rows = std::max(lost_rows, read.lost_rows);
    shrunk = std::max(shrunk, read.shrunk);
    turned += read.was_turned;
    with_orientation += read.ignored_orientation > 1;
    const glm::dmat3 axes = read.photograph.camera.world_from_view_rotation();
    const glm::ivec2 top = stored_top(read.ignored_orientation);
    up += double(top.x) * axes[0] + double(top.y) * axes[1];
  }

  void add_remarks(std::vector<Remark>& list) const {
    if (shrunk > 1)
      list.push_back({&remarks::photographs_resized, {{"factor", std::uint64_t(shrunk)}}});
    if (turned > 0) list.push_back({&remarks::photographs_turned, {{"count", turned}}});
    if (with_orientation > 0)
      list.push_back({&remarks::orientation_ignored, {{"count", with_orientation}}});
    if (distorted)
      list.push_back(
          {lost_columns + lost_rows > 0 ? &remarks::lens_undone_cropped : &remarks::lens_undone,
           {{"columns", std::uint64_t(lost_columns)}, {"rows", std::uint64_t(lost_rows)}}});
    if (widest_fisheye > 0)
      list.push_back({&remarks::fisheye_undone, {{"degrees", widest_fisheye}}});
  }
};

/// Where the dataset stores no sizes, all images of a part have that of the first.
void require_size_of_first(const ReadPhotograph& read, const fs::path& image, double scale,
                           glm::ivec2& first) {
  const Camera& camera = read.photograph.camera;
  if (first.x == 0) first = glm::ivec2(camera.width, camera.height);
  if (first != glm::ivec2(camera.width, camera.height))
    throw InputError({image.string()}, "the image is " + std::to_string(camera.width) + " x " +
                                           std::to_string(camera.height) + ", the first one " +
                                           std::to_string(first.x) + " x " +
                                           std::to_string(first.y) +
                                           (scale == 1 ? "" : " (after scaling)") +
                                           "; the dataset gives no sizes, so all must be equal");
}

/// Decides what alpha is, and applies it to all photographs.
void settle_alpha(Dataset& dataset, const std::vector<AlphaCounts>& all,
                  const std::optional<AlphaMeaning>& wanted) {
  const AlphaUse use = alpha_of(all);
  const AlphaMeaning meaning = wanted.value_or(use.meaning);
  for (auto* part : {&dataset.train, &dataset.test})
    for (Photograph& photograph : *part) apply_alpha(meaning, photograph);
  dataset.has_alpha = meaning == AlphaMeaning::background && use.photographs > 0;
  if (use.photographs == 0) return;
  const RemarkKind& kind = meaning == AlphaMeaning::background ? remarks::alpha_is_background
                           : meaning == AlphaMeaning::mask     ? remarks::alpha_is_mask
                                                               : remarks::alpha_ignored;
  dataset.remarks.push_back(
      {&kind, {{"count", std::uint64_t(use.photographs)}, {"all", std::uint64_t(all.size())}}});
}

}  // namespace

DatasetSummary read_dataset_summary(const fs::path& path, const DatasetOptions& options) {
  const MemoryBudget budget;
  FoundDataset found = find_dataset(path, options, budget);
  const DatasetOutline& outline = found.outline;
  DatasetSummary summary;
  std::optional<glm::ivec2> common_size;
  for (std::size_t i = 0; i < found.frames.size(); ++i) {
    if (i == outline.train.size()) common_size.reset();
    (i < outline.train.size() ? summary.train : summary.test)
        .push_back({stored_camera(*found.frames[i], found.files[i].image, outline.images_folder,
                                  budget, common_size),
                    kind_of(found.frames[i]->lens), found.files[i].mask.has_value()});
  }
  summary.points = outline.dataset.points;
  summary.up = outline.dataset.up;
  summary.remarks = outline.dataset.remarks;
  found.skipped.add_remarks(summary.remarks, found.files.size());
  return summary;
}

bool is_dataset(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    for (const char* name : {"transforms_train.json", "transforms_test.json", "transforms.json"})
      if (fs::exists(path / name, ignored)) return true;
    return !colmap_folders(path).empty() || bundler_files(path);
  }
  return fs::is_regular_file(path, ignored) && path.extension() == ".json" &&
         path.filename().string().starts_with("transforms");
}

std::optional<fs::path> dataset_around(const fs::path& path) {
  std::error_code ignored;
  const fs::path here = fs::absolute(path, ignored).lexically_normal();
  const fs::path above = (here.has_filename() ? here : here.parent_path()).parent_path();
  if (!fs::is_directory(path, ignored) || !is_dataset(above)) return std::nullopt;
  return above;
}

Dataset read_dataset(const fs::path& path, const DatasetOptions& given) {
  assert(given.scale > 0 && given.scale <= 1);
  assert(given.images_folder >= 1 && given.test_every >= 1);
  const MemoryBudget budget;
  FoundDataset found = find_dataset(path, given, budget);
  DatasetOptions options = given;
  options.images_folder = found.outline.images_folder;
  PixelStore store(budget);
  store.require_space(found.frames, options);

  Dataset dataset = std::move(found.outline.dataset);
  const std::size_t trained = found.outline.train.size();
  Observed observed;
  std::vector<AlphaCounts> alpha;
  std::uint64_t masked = 0;  // photographs with ignored pixels
  glm::ivec2 first_size(0);  // of images whose size the dataset does not give
  std::size_t read_count = 0;
  for (std::size_t i = 0; i < found.frames.size(); ++i) {
    if (options.progress) options.progress(double(i) / double(found.frames.size()));
    const DatasetFrame& frame = *found.frames[i];
    ReadPhotograph read;
    try {
      read = read_photograph(frame, found.files[i], options, budget);
    } catch (const InputError& error) {
      if (options.is_strict || is_about_memory(error)) throw;
      found.skipped.add(frame.name, error.without_hint());
      continue;
    }
    ++read_count;
    // Without sizes, an angle of view is meaningful only if all images of a split have the same
    // size.
    if (i == trained) first_size = glm::ivec2(0);
    if (!frame.size && !frame.any_size)
      require_size_of_first(read, found.files[i].image, options.scale, first_size);
    observed.add(frame, read);
    masked += !read.photograph.ignored.empty();
    alpha.push_back(read.alpha);
    store.keep(read.photograph);
    (i < trained ? dataset.train : dataset.test).push_back(std::move(read.photograph));
  }
  found.skipped.require_enough(found.outline.file, read_count, options.is_strict);
  if (options.part != DatasetPart::test && dataset.train.empty())
    throw InputError({found.outline.file}, "no photograph is left to train on");
  found.skipped.add_remarks(dataset.remarks, read_count);
  // The outline has the mean of the cameras' up axes, which lie on their side in such photographs.
  const auto& list = dataset.remarks;
  const bool is_mean = std::any_of(list.begin(), list.end(), [](const Remark& remark) {
    return remark.kind == &remarks::up_of_cameras || remark.kind == &remarks::up_of_no_camera;
  });
  if (is_mean && observed.with_orientation > 0 &&
      glm::length(observed.up) > least_mean_up * double(read_count))
    dataset.up = glm::vec3(glm::normalize(observed.up));
  observed.add_remarks(dataset.remarks);
  if (masked > 0)
    dataset.remarks.push_back(
        {&remarks::pixels_masked, {{"masked", masked}, {"all", std::uint64_t(read_count)}}});
  settle_alpha(dataset, alpha, options.alpha);
  if (options.progress) options.progress(1.0);
  return dataset;
}

}  // namespace tureen
