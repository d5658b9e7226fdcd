#include "formats/dataset/dataset.hpp"

#include <algorithm>
#include <cassert>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <string>

#include "base/existing_path.hpp"
#include "formats/dataset/colmap.hpp"
#include "formats/dataset/photograph.hpp"
#include "formats/dataset/transforms_dataset.hpp"
#include "formats/gltf/uri.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

using Frames = std::vector<DatasetFrame>;

/// A dataset before its photographs are read.
struct Outline {
  std::string file;  // the file that lists the photographs, for messages
  Frames train, test;
  Dataset dataset;  // all but the photographs
};

void sort_by_name(Frames& frames) {
  std::stable_sort(frames.begin(), frames.end(),
                   [](const DatasetFrame& a, const DatasetFrame& b) { return a.name < b.name; });
}

/// Every n-th in name order is a test view, beginning with the first. A training needs the only
/// photograph of a dataset itself.
void split(Frames all, const DatasetOptions& options, Outline& outline) {
  sort_by_name(all);
  if (all.size() == 1 && options.part != DatasetPart::test) {
    outline.train = std::move(all);
    return;
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    (i % std::size_t(options.test_every) == 0 ? outline.test : outline.train)
        .push_back(std::move(all[i]));
}

void take_transforms_up(Dataset& dataset) {
  dataset.up = glm::vec3(0, 0, 1);
  dataset.remarks.push_back({Remark::Kind::up_of_transforms});
}

Outline one_transforms_file(const fs::path& path, const DatasetOptions& options,
                            const MemoryBudget& budget) {
  Outline outline;
  outline.file = path.string();
  split(read_transforms_dataset(path, options.images_folder, budget), options, outline);
  take_transforms_up(outline.dataset);
  return outline;
}

Outline file_a_split(const fs::path& folder, const DatasetOptions& options,
                     const MemoryBudget& budget) {
  Outline outline;
  const auto read = [&](const char* name) {
    outline.file = (folder / name).string();
    std::error_code ignored;
    if (!fs::exists(folder / name, ignored))
      throw InputError(
          {(folder / name).string(), {}, {}},
          "is missing, but the other half of the dataset's split exists",
          "to read the other half alone, pass its file instead of the folder; every n-th "
          "photograph then becomes a test view");
    Frames frames = read_transforms_dataset(folder / name, options.images_folder, budget);
    sort_by_name(frames);
    return frames;
  };
  if (options.part != DatasetPart::test) outline.train = read("transforms_train.json");
  if (options.part != DatasetPart::train) outline.test = read("transforms_test.json");
  if (options.part == DatasetPart::all) outline.file = folder.string();
  take_transforms_up(outline.dataset);
  return outline;
}

/// Up is the mean of the cameras' up axes, because most cameras are held upright.
void take_mean_up(const Frames& frames, Dataset& dataset) {
  glm::dvec3 sum(0);
  for (const DatasetFrame& frame : frames)
    sum += glm::dvec3(frame.view_from_world[0][1], frame.view_from_world[1][1],
                      frame.view_from_world[2][1]);
  // The mean of scattered axes is short. In this case y points down, as in the first camera.
  if (glm::length(sum) > 0.1 * double(frames.size())) {
    dataset.up = glm::vec3(glm::normalize(sum));
    dataset.remarks.push_back({Remark::Kind::up_of_cameras});
  } else {
    dataset.up = glm::vec3(0, -1, 0);
    dataset.remarks.push_back({Remark::Kind::up_of_no_camera});
  }
}

Outline colmap_outline(const fs::path& folder, const fs::path& model_folder,
                       const DatasetOptions& options, const MemoryBudget& budget) {
  Outline outline;
  outline.file = model_folder.string();
  ColmapModel model = read_colmap(model_folder, budget);
  Frames frames;
  for (const ColmapImage& image : model.images) {
    const ColmapCamera& camera = model.cameras.at(image.camera);
    DatasetFrame frame;
    frame.name = frame.file = image.name;
    frame.folder =
        folder /
        (options.images_folder == 1 ? "images" : "images_" + std::to_string(options.images_folder));
    frame.size = glm::ivec2(camera.pinhole.width, camera.pinhole.height);
    frame.lens = camera.lens;
    frame.view_from_world = image.view_from_world;
    frame.camera = [pinhole = camera.pinhole, pose = image.view_from_world](int, int) {
      Camera posed = pinhole;
      posed.view_from_world = pose;
      return posed;
    };
    frames.push_back(std::move(frame));
  }
  take_mean_up(frames, outline.dataset);
  outline.dataset.points = std::move(model.points);
  split(std::move(frames), options, outline);
  return outline;
}

Outline make_outline(const fs::path& path, const DatasetOptions& options,
                     const MemoryBudget& budget) {
  require_there(path);
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return one_transforms_file(path, options, budget);
  for (const char* name : {"transforms_train.json", "transforms_test.json"})
    if (fs::exists(path / name, ignored)) return file_a_split(path, options, budget);
  if (fs::exists(path / "transforms.json", ignored))
    return one_transforms_file(path / "transforms.json", options, budget);
  if (const auto model = colmap_folder(path)) return colmap_outline(path, *model, options, budget);
  throw InputError({path.string(), {}, {}},
                   "not a supported dataset: it has neither transforms_train.json nor "
                   "transforms.json, nor COLMAP's cameras in sparse/0, sparse or colmap/sparse/0");
}

/// Rejects a part without photographs. All of a dataset may have no test views.
void require_photographs(const Outline& outline, const DatasetOptions& options) {
  const auto refuse = [&](const Frames& frames, bool needed, const char* what) {
    if (needed && frames.empty())
      throw InputError({outline.file, {}, {}},
                       std::string("there are no photographs to ") + what + ": it has " +
                           std::to_string(outline.train.size()) + " to train on and " +
                           std::to_string(outline.test.size()) + " to test");
  };
  refuse(outline.train, options.part != DatasetPart::test, "train on");
  refuse(outline.test, options.part == DatasetPart::test, "test");
}

/// The images of all frames, or an InputError with the names of those that are missing.
std::vector<fs::path> find_images(const std::string& file,
                                  const std::vector<const DatasetFrame*>& frames,
                                  const DatasetOptions& options) {
  constexpr std::size_t named = 12;
  std::vector<fs::path> images;
  std::string missing;
  std::size_t missing_count = 0;
  for (const DatasetFrame* frame : frames) {
    try {
      const std::optional<fs::path> image = find_image(*frame, options.images_folder);
      if (image)
        images.push_back(*image);
      else if (missing_count++ < named)
        missing += (missing.empty() ? "" : ", ") + frame->file;
    } catch (const UriError& error) {
      throw InputError({file, {}, {}}, error.reason);
    }
  }
  if (missing_count > named) missing += " and " + std::to_string(missing_count - named) + " more";
  if (missing_count > 0)
    throw InputError({file, {}, {}},
                     std::to_string(missing_count) + " of " + std::to_string(frames.size()) +
                         " photographs are missing in " +
                         (frames[0]->folder.empty() ? "." : frames[0]->folder.string()) + ": " +
                         missing);
  return images;
}

/// Rejects photographs that exceed the budget before they are decoded, which may take a minute.
/// Possible only if the dataset stores their sizes.
void require_budget(const std::string& file, const std::vector<const DatasetFrame*>& frames,
                    const DatasetOptions& options, const MemoryBudget& budget) {
  double pixels = 0;
  for (const DatasetFrame* frame : frames)
    if (frame->size)
      pixels += double(scaled_side(frame->size->x, options.scale / options.images_folder)) *
                scaled_side(frame->size->y, options.scale / options.images_folder);
  // Cropping removes less than half of the pixels, so the limit is twice the budget.
  if (pixels * sizeof(glm::u8vec4) > 2.0 * double(budget.left()))
    throw InputError({file, {}, {}}, budget.refusal("the photographs"),
                     std::string(max_memory_hint) + ", --scale makes them smaller");
}

bool transparent_somewhere(const Image8& image) {
  return std::any_of(image.pixels.begin(), image.pixels.end(),
                     [](const glm::u8vec4& pixel) { return pixel.a < 255; });
}

}  // namespace

Dataset read_dataset(const fs::path& path, const DatasetOptions& options) {
  assert(options.scale > 0 && options.scale <= 1);
  assert(options.images_folder >= 1 && options.test_every >= 1);
  const MemoryBudget budget;
  Outline outline = make_outline(path, options, budget);
  require_photographs(outline, options);
  if (options.part == DatasetPart::test) outline.train.clear();
  if (options.part == DatasetPart::train) outline.test.clear();

  std::vector<const DatasetFrame*> frames;
  for (const DatasetFrame& frame : outline.train) frames.push_back(&frame);
  for (const DatasetFrame& frame : outline.test) frames.push_back(&frame);
  const std::vector<fs::path> images = find_images(outline.file, frames, options);
  require_budget(outline.file, frames, options, budget);

  Dataset dataset = std::move(outline.dataset);
  bool distorted = false;
  glm::ivec2 first_size(0);  // of images whose size the dataset does not give
  int lost_columns = 0, lost_rows = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (options.progress) options.progress(double(i) / double(frames.size()));
    ReadPhotograph read = read_photograph(*frames[i], images[i], options, budget);
    // Without sizes, an angle of view is meaningful only if all images of a split have the same
    // size.
    if (i == outline.train.size()) first_size = glm::ivec2(0);
    if (!frames[i]->size) {
      const Camera& camera = read.photograph.camera;
      if (first_size.x == 0) first_size = glm::ivec2(camera.width, camera.height);
      if (first_size != glm::ivec2(camera.width, camera.height))
        throw InputError({images[i].string(), {}, {}},
                         "the image is " + std::to_string(camera.width) + " x " +
                             std::to_string(camera.height) + ", the first one " +
                             std::to_string(first_size.x) + " x " + std::to_string(first_size.y) +
                             (options.scale == 1 ? "" : " (after scaling)") +
                             "; the dataset gives no sizes, so all must be equal");
    }
    distorted = distorted || !frames[i]->lens.is_pinhole();
    lost_columns = std::max(lost_columns, read.lost_columns);
    lost_rows = std::max(lost_rows, read.lost_rows);
    dataset.has_alpha = dataset.has_alpha || transparent_somewhere(read.photograph.image);
    (i < outline.train.size() ? dataset.train : dataset.test).push_back(std::move(read.photograph));
  }
  if (distorted)
    dataset.remarks.push_back(
        {Remark::Kind::lens_undone, {std::uint64_t(lost_columns), std::uint64_t(lost_rows)}});
  if (options.progress) options.progress(1.0);
  return dataset;
}

}  // namespace tureen
