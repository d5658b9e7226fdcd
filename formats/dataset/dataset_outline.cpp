#include "formats/dataset/dataset_outline.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "base/existing_path.hpp"
#include "base/extension.hpp"
#include "base/text_scanner.hpp"
#include "formats/dataset/bundler.hpp"
#include "formats/dataset/colmap.hpp"
#include "formats/dataset/dataset_points.hpp"
#include "formats/dataset/dataset_remarks.hpp"
#include "formats/dataset/transforms_dataset.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

void take_points(FoundPoints found, Dataset& dataset) {
  dataset.points = std::move(found.points);
  dataset.remarks.insert(dataset.remarks.end(), found.remarks.begin(), found.remarks.end());
  if (dataset.points.empty()) dataset.remarks.push_back({&remarks::points_none});
}

void take_split(Frames all, const NamedSplit& named, const DatasetOptions& options,
                DatasetOutline& outline) {
  SplitFrames parts =
      split(std::move(all), named, options.test_every, options.part == DatasetPart::test);
  outline.train = std::move(parts.train);
  outline.test = std::move(parts.test);
  std::vector<Remark>& list = outline.dataset.remarks;
  list.insert(list.end(), parts.remarks.begin(), parts.remarks.end());
}

void take_transforms_up(Dataset& dataset) {
  dataset.up = glm::vec3(0, 0, 1);
  dataset.remarks.push_back({&remarks::up_of_transforms});
}

DatasetOutline one_transforms_file(const fs::path& path, const DatasetOptions& options,
                                   const MemoryBudget& budget) {
  DatasetOutline outline{.file = path.string(), .images_folder = options.images_folder};
  TransformsDataset read = read_transforms_dataset(path, options.images_folder, budget);
  take_split(std::move(read.frames), read.split, options, outline);
  take_transforms_up(outline.dataset);
  take_points(std::move(read.points), outline.dataset);
  return outline;
}

/// transforms_train.json and transforms_test.json, or instead transforms_val.json. Without either,
/// every n-th photograph is a test view.
DatasetOutline file_a_split(const fs::path& folder, const DatasetOptions& options,
                            const MemoryBudget& budget) {
  DatasetOutline outline{
      .file = folder.string(), .images_folder = options.images_folder, .has_own_test = true};
  const char* const test_file =
      is_there(folder / "transforms_test.json") ? "transforms_test.json" : "transforms_val.json";
  if (!is_there(folder / test_file))
    return one_transforms_file(folder / "transforms_train.json", options, budget);
  if (!is_there(folder / "transforms_train.json"))
    throw InputError({(folder / "transforms_train.json").string()},
                     "is missing, but the other half of the dataset's split exists",
                     "to read the other half alone, pass its file instead of the folder; every "
                     "n-th photograph then becomes a test view");
  bool has_points = false;
  const auto read = [&](const char* name) {
    TransformsDataset part = read_transforms_dataset(folder / name, options.images_folder, budget);
    sort_by_name(part.frames);
    // Both files name the same points.
    if (!std::exchange(has_points, true)) take_points(std::move(part.points), outline.dataset);
    return std::move(part.frames);
  };
  if (options.part != DatasetPart::test) outline.train = read("transforms_train.json");
  if (options.part != DatasetPart::train) outline.test = read(test_file);
  if (options.part != DatasetPart::all)
    outline.file =
        (folder / (options.part == DatasetPart::test ? test_file : "transforms_train.json"))
            .string();
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
  if (glm::length(sum) > least_mean_up * double(frames.size())) {
    dataset.up = glm::vec3(glm::normalize(sum));
    dataset.remarks.push_back({&remarks::up_of_cameras});
  } else {
    dataset.up = glm::vec3(0, y_down ? -1 : 1, 0);
    dataset.remarks.push_back({&remarks::up_of_no_camera, {{"axis", y_down ? "-y" : "y"}}});
  }
}

/// The lines of a text file, such as test.txt of 3D Gaussian Splatting; none without it.
std::vector<std::string> lines_of(const fs::path& file, const MemoryBudget& budget) {
  std::vector<std::string> lines;
  if (!is_there(file)) return lines;
  Input input = Input::open(file, budget);
  TextScanner text(input);
  for (bool more = true; more; more = text.next_line())
    if (std::string line = text.read_line(); !line.empty()) lines.push_back(std::move(line));
  return lines;
}

void add_remark_on_models(const std::vector<fs::path>& folders, const fs::path& chosen,
                          std::size_t photographs, std::vector<Remark>& list) {
  if (folders.size() < 2) return;
  std::vector<std::string> others;
  for (const fs::path& folder : folders)
    if (folder != chosen) others.push_back(folder.filename().string());
  list.push_back({&remarks::models_several,
                  {{"chosen", chosen.filename().string()},
                   {"count", std::uint64_t(photographs)},
                   {"others", others}}});
}

std::string images_name(int images_folder) {
  return images_folder == 1 ? "images" : "images_" + std::to_string(images_folder);
}

/// The folder of the photographs: images or images_N; without images, the largest images_N; without
/// any, the dataset's own folder. `model` is the folder of the cameras, in that of the dataset.
fs::path images_of(const fs::path& dataset, const fs::path& model, DatasetOutline& outline) {
  // COLMAP's undistorted models have photographs of their own: dense/images for dense/sparse/0.
  fs::path folder = model;
  while (folder.filename() != "sparse" && folder != dataset) folder = folder.parent_path();
  folder = folder == dataset ? dataset : folder.parent_path();
  if (!is_there(folder / images_name(outline.images_folder))) folder = dataset;
  if (is_there(folder / images_name(outline.images_folder)))
    return folder / images_name(outline.images_folder);
  if (outline.images_folder > 1) return folder / images_name(outline.images_folder);
  for (const int smaller : {2, 4, 8})
    if (is_there(folder / images_name(smaller))) {
      outline.images_folder = smaller;
      outline.dataset.remarks.push_back(
          {&remarks::smaller_images, {{"folder", images_name(smaller)}}});
      return folder / images_name(smaller);
    }
  return is_there(folder / "input") ? folder / "input" : folder;
}

DatasetOutline colmap_outline(const fs::path& folder, const std::vector<fs::path>& models,
                              const DatasetOptions& options, const MemoryBudget& budget) {
  DatasetOutline outline{.images_folder = options.images_folder};
  const fs::path path = largest_model(models, budget);
  const ColmapModel model = read_colmap_poses(path, budget);
  add_remark_on_models(models, path, usable_images(model), outline.dataset.remarks);
  outline.file = path.string();
  const fs::path images = images_of(folder, path, outline);
  Frames frames;
  for (const ColmapImage& image : model.images) {
    DatasetFrame frame;
    frame.name = frame.file = image.name;
    frame.folder = images;
    frame.dataset = folder;
    frame.defect = image.defect;
    frame.view_from_world = image.view_from_world;
    if (frame.defect.empty() && model.cameras.at(image.camera).is_panorama) {
      const Camera& photograph = model.cameras.at(image.camera).pinhole;
      frame.size = glm::ivec2(photograph.width, photograph.height);
      add_faces(frame, frames);
      continue;
    }
    if (frame.defect.empty()) {
      const ColmapCamera& camera = model.cameras.at(image.camera);
      frame.size = glm::ivec2(camera.pinhole.width, camera.pinhole.height);
      frame.lens = camera.lens;
      frame.camera = [pinhole = camera.pinhole, pose = image.view_from_world](int, int) {
        Camera posed = pinhole;
        posed.view_from_world = pose;
        return posed;
      };
    }
    frames.push_back(std::move(frame));
  }
  take_mean_up(frames, true, outline.dataset);
  take_points(points_of_model(path, budget), outline.dataset);
  NamedSplit named;
  for (const fs::path& list : {path / "test.txt", folder / "test.txt"})
    if (named.test.empty())
      named = {.test = lines_of(list, budget), .source = list.filename().string()};
  take_split(std::move(frames), named, options, outline);
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

DatasetOutline bundler_outline(const fs::path& folder, const BundlerFiles& files,
                               const DatasetOptions& options, const MemoryBudget& budget) {
  DatasetOutline outline{.images_folder = options.images_folder};
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
    frame.folder = frame.dataset = folder;
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
  take_points({.points = std::move(model.points)}, outline.dataset);
  take_split(std::move(frames), {}, options, outline);
  return outline;
}

}  // namespace

DatasetOutline read_outline(const fs::path& path, const DatasetOptions& options,
                            const MemoryBudget& budget) {
  require_there(path);
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) {
    if (extension_of(path) != ".json") {
      Input::open(path);  // reports a file that may not be read
      throw InputError({path.string()}, "is neither a folder nor a transforms.json",
                       "for photographs without cameras, pass their folder or a video to tureen "
                       "cameras or train");
    }
    return one_transforms_file(path, options, budget);
  }
  for (const char* name : {"transforms_train.json", "transforms_test.json"})
    if (is_there(path / name)) return file_a_split(path, options, budget);
  if (is_there(path / "transforms.json"))
    return one_transforms_file(path / "transforms.json", options, budget);
  if (const auto models = colmap_folders(path); !models.empty())
    return colmap_outline(path, models, options, budget);
  if (const auto files = bundler_files(path)) return bundler_outline(path, *files, options, budget);
  const auto around = dataset_around(path);
  throw InputError(
      {path.string()},
      "not a supported dataset: it has neither transforms_train.json nor transforms.json, nor "
      "COLMAP's cameras in sparse/0, sparse, colmap/sparse, undistorted/sparse, dense/sparse or "
      "the "
      "folder itself, nor Bundler's bundle.out",
      around ? "did you mean " + around->string() + ", the dataset around it?"
             : "pass the folder that contains them; docs/datasets.md lists what is read");
}

}  // namespace tureen
