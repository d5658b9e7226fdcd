#include "formats/dataset/transforms_dataset.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/input.hpp"
#include "base/json/json_file.hpp"
#include "formats/dataset/camera_json.hpp"
#include "formats/dataset/colmap.hpp"
#include "formats/dataset/near_files.hpp"
#include "formats/dataset/transforms_json.hpp"

namespace tureen {

namespace {

/// "./images/a.jpg" as "images_4/a.jpg" for the folder "images"; nullopt if the name begins with
/// another folder.
std::optional<std::string> in_folder(const std::string& folder, const std::string& name,
                                     int images_folder) {
  if (images_folder == 1) return name;
  const std::string rest = name.substr(name.starts_with("./") ? 2 : 0);
  if (!rest.starts_with(folder + "/")) return {};
  return folder + "_" + std::to_string(images_folder) + rest.substr(folder.size());
}

/// The points of a COLMAP model beside the file, in the coordinates of the frames.
FoundPoints mapped_points(const std::filesystem::path& model, const glm::dmat4& applied,
                          const CameraJson& json, const MemoryBudget& budget) {
  FoundPoints found = points_of_model(model, budget);
  for (DatasetPoint& point : found.points) {
    point.position = glm::dvec3(applied * glm::dvec4(point.position, 1));
    for (int i = 0; i < 3; ++i)
      if (!std::isfinite(point.position[i]))
        json.fail("applied_transform maps a point to infinity");
  }
  return found;
}

FoundPoints read_points(const CameraJson& json, const std::filesystem::path& folder,
                        const MemoryBudget& budget) {
  const std::optional<glm::dmat4> applied = json.maybe_affine("applied_transform");
  if (const std::string name = json.text("ply_file_path"); !name.empty()) {
    NearFiles files;
    constexpr const char* suffixes[] = {".ply"};
    const auto found = files.find(folder, name, suffixes);
    return points_of_ply(found ? found->path : folder / name, name, budget);
  }
  if (const auto models = colmap_folders(folder); applied && !models.empty())
    return mapped_points(largest_model(models, budget), *applied, json, budget);
  return points_beside(folder, budget);
}

/// The texts of a list; none without it.
std::vector<std::string> texts(const nlohmann::json& root, const char* key) {
  std::vector<std::string> result;
  if (const auto list = root.find(key); list != root.end() && list->is_array())
    for (const nlohmann::json& text : *list)
      if (text.is_string()) result.push_back(text.get<std::string>());
  return result;
}

DatasetFrame made_of(const TransformsFrame& frame, const std::filesystem::path& folder,
                     int images_folder) {
  DatasetFrame made;
  made.name = frame.file_path;
  made.folder = made.dataset = folder;
  made.defect = frame.defect;
  if (made.defect.empty() && frame.file_path.empty()) made.defect = "file_path is missing";
  if (made.defect.empty() && !frame.other_lens.empty())
    made.defect = frame.other_lens == "k4"
                      ? "k4 needs camera_model FULL_OPENCV or OPENCV_FISHEYE"
                      : "the lens " + frame.other_lens +
                            " is not supported in transforms.json; undistort the images first";
  const std::optional<std::string> file = in_folder("images", frame.file_path, images_folder);
  if (made.defect.empty() && !file)
    made.defect = "its name does not begin with images/, so there is no smaller copy in images_" +
                  std::to_string(images_folder) + "/";
  if (!made.defect.empty()) return made;
  made.file = *file;
  if (frame.width && frame.height) made.size = glm::ivec2(*frame.width, *frame.height);
  made.view_from_world = frame.view_from_world;
  made.camera = [frame](int width, int height) { return pinhole(frame, width, height); };
  made.lens = frame.is_fisheye ? fisheye(frame.lens) : brown(frame.lens);
  // Folders of smaller masks are named like those of smaller images.
  if (!frame.mask_path.empty())
    made.mask = in_folder("masks", frame.mask_path, images_folder).value_or(frame.mask_path);
  return made;
}

}  // namespace

TransformsDataset read_transforms_dataset(const std::filesystem::path& path, int images_folder,
                                          const MemoryBudget& budget) {
  Input input = Input::open(path, budget);
  const nlohmann::json root = read_json(input, RepeatedKeys::last_counts, NonFinite::null);
  if (!root.is_object() || !root.contains("frames"))
    throw InputError({input.name()}, "has no list \"frames\", so it is not a transforms.json");
  TransformsDataset dataset;
  dataset.split = {.train = texts(root, "train_filenames"),
                   .validation = texts(root, "val_filenames"),
                   .test = texts(root, "test_filenames"),
                   .source = path.filename().string()};
  const auto take = [&](const char* key) {
    for (const TransformsFrame& frame : read_transforms(root, input.name(), key)) {
      DatasetFrame made = made_of(frame, path.parent_path(), images_folder);
      if (made.name.empty()) made.name = "frame " + std::to_string(dataset.frames.size());
      if (frame.is_panorama && made.defect.empty())
        add_faces(made, dataset.frames);
      else
        dataset.frames.push_back(std::move(made));
    }
  };
  take("frames");
  if (const auto tests = root.find("test_frames"); tests != root.end() && tests->is_array()) {
    const std::size_t first = dataset.frames.size();
    take("test_frames");
    for (std::size_t i = first; i < dataset.frames.size(); ++i)
      dataset.split.test.push_back(dataset.frames[i].name);
  }
  dataset.points = read_points(CameraJson({.object = root, .file = input.name(), .where = ""}),
                               path.parent_path(), budget);
  return dataset;
}

}  // namespace tureen
