#include "formats/dataset/dataset.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>

#include "base/existing_path.hpp"
#include "formats/common/uri.hpp"
#include "formats/dataset/bundler.hpp"
#include "formats/dataset/colmap.hpp"
#include "formats/dataset/dataset_remarks.hpp"
#include "formats/dataset/photograph.hpp"
#include "formats/dataset/transforms_dataset.hpp"
#include "image/png.hpp"

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
  dataset.remarks.push_back({&remarks::up_of_transforms});
}

void take_points(TransformsDataset& read, Dataset& dataset) {
  dataset.points = std::move(read.points);
  dataset.remarks.insert(dataset.remarks.end(), read.remarks.begin(), read.remarks.end());
}

Outline one_transforms_file(const fs::path& path, const DatasetOptions& options,
                            const MemoryBudget& budget) {
  Outline outline;
  outline.file = path.string();
  TransformsDataset read = read_transforms_dataset(path, options.images_folder, budget);
  split(std::move(read.frames), options, outline);
  take_transforms_up(outline.dataset);
  take_points(read, outline.dataset);
  return outline;
}

Outline file_a_split(const fs::path& folder, const DatasetOptions& options,
                     const MemoryBudget& budget) {
  Outline outline;
  const auto read = [&](const char* name) {
    outline.file = (folder / name).string();
    std::error_code ignored;
    if (!fs::exists(folder / name, ignored))
      throw InputError({(folder / name).string()},
                       "is missing, but the other half of the dataset's split exists",
                       "to read the other half alone, pass its file instead of the folder; every "
                       "n-th photograph then becomes a test view");
    TransformsDataset part = read_transforms_dataset(folder / name, options.images_folder, budget);
    sort_by_name(part.frames);
    // Both files name the same points.
    if (outline.dataset.points.empty() && outline.dataset.remarks.empty())
      take_points(part, outline.dataset);
    return std::move(part.frames);
  };
  if (options.part != DatasetPart::test) outline.train = read("transforms_train.json");
  if (options.part != DatasetPart::train) outline.test = read("transforms_test.json");
  if (options.part == DatasetPart::all) outline.file = folder.string();
  take_transforms_up(outline.dataset);
  return outline;
}

/// Up is the mean of the cameras' up axes, because most cameras are held upright. Without one, it
/// is y, or -y with `y_down`.
void take_mean_up(const Frames& frames, bool y_down, Dataset& dataset) {
  glm::dvec3 sum(0);
  for (const DatasetFrame& frame : frames)
    sum += glm::dvec3(frame.view_from_world[0][1], frame.view_from_world[1][1],
                      frame.view_from_world[2][1]);
  // The mean of scattered axes is short.
  if (glm::length(sum) > 0.1 * double(frames.size())) {
    dataset.up = glm::vec3(glm::normalize(sum));
    dataset.remarks.push_back({&remarks::up_of_cameras});
  } else {
    dataset.up = glm::vec3(0, y_down ? -1 : 1, 0);
    dataset.remarks.push_back({&remarks::up_of_no_camera, {{"axis", y_down ? "-y" : "y"}}});
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
  take_mean_up(frames, true, outline.dataset);
  outline.dataset.points = std::move(model.points);
  split(std::move(frames), options, outline);
  return outline;
}

/// Where a photograph of a Bundler dataset is: as listed from the dataset's folder, otherwise in
/// its folder of images.
std::string bundler_image(const fs::path& folder, const std::string& name, int images_folder) {
  const std::string bare = name.starts_with("images/") ? name.substr(7) : name;
  if (images_folder != 1) return "images_" + std::to_string(images_folder) + "/" + bare;
  std::error_code ignored;
  return !fs::exists(folder / name, ignored) && fs::exists(folder / "images" / bare, ignored)
             ? "images/" + bare
             : name;
}

Outline bundler_outline(const fs::path& folder, const BundlerFiles& files,
                        const DatasetOptions& options, const MemoryBudget& budget) {
  Outline outline;
  outline.file = files.model.string();
  if (files.list.empty())
    throw InputError({files.model.string()},
                     "the list of its images is missing: list.txt or bundle.out.list.txt");
  Input list = Input::open(files.list, budget);
  const std::vector<std::string> names = read_bundler_list(list);
  Input input = Input::open(files.model, budget);
  BundlerModel model = read_bundler(input);
  if (names.size() != model.cameras.size())
    throw InputError({files.list.string()}, "it lists " + std::to_string(names.size()) +
                                                " images, but " + files.model.string() + " has " +
                                                std::to_string(model.cameras.size()) + " cameras");
  Frames frames;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const BundlerCamera& found = model.cameras[i];
    if (found.focal == 0) continue;  // the reconstruction does not have this image
    DatasetFrame frame;
    frame.name = names[i];
    frame.folder = folder;
    const std::string relative = names[i].starts_with("./") ? names[i].substr(2) : names[i];
    frame.file = bundler_image(folder, relative, options.images_folder);
    frame.any_size = true;
    frame.lens = found.lens;
    frame.view_from_world = found.view_from_world;
    frame.camera = [found](int width, int height) {
      Camera camera;
      camera.width = width;
      camera.height = height;
      camera.fx = camera.fy = found.focal;
      camera.cx = 0.5 * width;
      camera.cy = 0.5 * height;
      camera.view_from_world = found.view_from_world;
      return camera;
    };
    frames.push_back(std::move(frame));
  }
  take_mean_up(frames, false, outline.dataset);
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
  if (const auto files = bundler_files(path)) return bundler_outline(path, *files, options, budget);
  throw InputError(
      {path.string()},
      "not a supported dataset: it has neither transforms_train.json nor transforms.json, nor "
      "COLMAP's cameras in sparse/0, sparse or colmap/sparse/0, nor Bundler's bundle.out");
}

/// Rejects a part without photographs. All of a dataset may have no test views.
void require_photographs(const Outline& outline, const DatasetOptions& options) {
  const auto refuse = [&](const Frames& frames, bool needed, const char* what) {
    if (needed && frames.empty())
      throw InputError({outline.file}, std::string("there are no photographs to ") + what +
                                           ": it has " + std::to_string(outline.train.size()) +
                                           " to train on and " +
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
      find_mask(*frame);
      const std::optional<fs::path> image = find_image(*frame, options.images_folder);
      if (image)
        images.push_back(*image);
      else if (missing_count++ < named)
        missing += (missing.empty() ? "" : ", ") + frame->file;
    } catch (const UriError& error) {
      throw InputError({file}, error.reason);
    }
  }
  if (missing_count > named) missing += " and " + std::to_string(missing_count - named) + " more";
  if (missing_count > 0)
    throw InputError({file}, std::to_string(missing_count) + " of " +
                                 std::to_string(frames.size()) + " photographs are missing in " +
                                 (frames[0]->folder.empty() ? "." : frames[0]->folder.string()) +
                                 ": " + missing);
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
    throw InputError({file}, budget.refusal("the photographs"),
                     std::string(max_memory_hint) + ", --scale makes them smaller");
}

/// Between the left and the right edge, in degrees.
double angle_of_view(const Camera& camera) {
  return glm::degrees(std::atan(camera.cx / camera.fx) +
                      std::atan((camera.width - camera.cx) / camera.fx));
}

bool transparent_somewhere(const Image8& image) {
  return std::any_of(image.pixels.begin(), image.pixels.end(),
                     [](const glm::u8vec4& pixel) { return pixel.a < 255; });
}

/// The frames of the requested part, train first, and their images.
struct FoundDataset {
  Outline outline;
  std::vector<const DatasetFrame*> frames;  // in `outline`
  std::vector<fs::path> images;
};

FoundDataset find_dataset(const fs::path& path, const DatasetOptions& options,
                          const MemoryBudget& budget) {
  FoundDataset found{make_outline(path, options, budget), {}, {}};
  Outline& outline = found.outline;
  require_photographs(outline, options);
  if (options.part == DatasetPart::test) outline.train.clear();
  if (options.part == DatasetPart::train) outline.test.clear();
  // Moving a vector keeps the addresses of its elements.
  for (const DatasetFrame& frame : outline.train) found.frames.push_back(&frame);
  for (const DatasetFrame& frame : outline.test) found.frames.push_back(&frame);
  found.images = find_images(outline.file, found.frames, options);
  return found;
}

LensKind kind_of(const Lens& lens) {
  if (lens.model == LensModel::fisheye) return LensKind::fisheye;
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
    camera = resampled(camera, scaled_side(size.x, 1.0 / images_folder),
                       scaled_side(size.y, 1.0 / images_folder));
  camera.name = frame.name;
  return camera;
}

}  // namespace

DatasetSummary read_dataset_summary(const fs::path& path, const DatasetOptions& options) {
  const MemoryBudget budget;
  auto [outline, frames, images] = find_dataset(path, options, budget);
  DatasetSummary summary;
  std::optional<glm::ivec2> common_size;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i == outline.train.size()) common_size.reset();
    (i < outline.train.size() ? summary.train : summary.test)
        .push_back(
            {stored_camera(*frames[i], images[i], options.images_folder, budget, common_size),
             kind_of(frames[i]->lens), !frames[i]->mask.empty()});
  }
  summary.points = std::move(outline.dataset.points);
  summary.up = outline.dataset.up;
  summary.remarks = std::move(outline.dataset.remarks);
  return summary;
}

bool is_dataset(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    for (const char* name : {"transforms_train.json", "transforms_test.json", "transforms.json"})
      if (fs::exists(path / name, ignored)) return true;
    return colmap_folder(path) || bundler_files(path);
  }
  return fs::is_regular_file(path, ignored) && path.extension() == ".json" &&
         path.filename().string().starts_with("transforms");
}

Dataset read_dataset(const fs::path& path, const DatasetOptions& options) {
  assert(options.scale > 0 && options.scale <= 1);
  assert(options.images_folder >= 1 && options.test_every >= 1);
  const MemoryBudget budget;
  auto [outline, frames, images] = find_dataset(path, options, budget);
  require_budget(outline.file, frames, options, budget);

  Dataset dataset = std::move(outline.dataset);
  bool distorted = false;
  double widest_fisheye = 0;  // between the left and the right edge, in degrees
  std::uint64_t masked = 0;   // photographs with ignored pixels
  glm::ivec2 first_size(0);   // of images whose size the dataset does not give
  int lost_columns = 0, lost_rows = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (options.progress) options.progress(double(i) / double(frames.size()));
    ReadPhotograph read = read_photograph(*frames[i], images[i], options, budget);
    // Without sizes, an angle of view is meaningful only if all images of a split have the same
    // size.
    if (i == outline.train.size()) first_size = glm::ivec2(0);
    if (!frames[i]->size && !frames[i]->any_size) {
      const Camera& camera = read.photograph.camera;
      if (first_size.x == 0) first_size = glm::ivec2(camera.width, camera.height);
      if (first_size != glm::ivec2(camera.width, camera.height))
        throw InputError({images[i].string()},
                         "the image is " + std::to_string(camera.width) + " x " +
                             std::to_string(camera.height) + ", the first one " +
                             std::to_string(first_size.x) + " x " + std::to_string(first_size.y) +
                             (options.scale == 1 ? "" : " (after scaling)") +
                             "; the dataset gives no sizes, so all must be equal");
    }
    if (frames[i]->lens.model == LensModel::fisheye)
      widest_fisheye = std::max(widest_fisheye, angle_of_view(read.photograph.camera));
    else
      distorted = distorted || !frames[i]->lens.is_pinhole();
    masked += !read.photograph.ignored.empty();
    lost_columns = std::max(lost_columns, read.lost_columns);
    lost_rows = std::max(lost_rows, read.lost_rows);
    dataset.has_alpha = dataset.has_alpha || transparent_somewhere(read.photograph.image);
    (i < outline.train.size() ? dataset.train : dataset.test).push_back(std::move(read.photograph));
  }
  if (distorted)
    dataset.remarks.push_back(
        {lost_columns + lost_rows > 0 ? &remarks::lens_undone_cropped : &remarks::lens_undone,
         {{"columns", std::uint64_t(lost_columns)}, {"rows", std::uint64_t(lost_rows)}}});
  if (widest_fisheye > 0)
    dataset.remarks.push_back({&remarks::fisheye_undone, {{"degrees", widest_fisheye}}});
  if (masked > 0)
    dataset.remarks.push_back(
        {&remarks::pixels_masked, {{"masked", masked}, {"all", frames.size()}}});
  if (options.progress) options.progress(1.0);
  return dataset;
}

}  // namespace tureen
