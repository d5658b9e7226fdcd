#include "formats/dataset/transforms_dataset.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/input.hpp"
#include "base/json/json_file.hpp"
#include "formats/common/uri.hpp"
#include "formats/dataset/camera_json.hpp"
#include "formats/dataset/colmap.hpp"
#include "formats/dataset/dataset_remarks.hpp"
#include "formats/dataset/points_ply.hpp"
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

/// TransformsDataset::points, and the remark about a missing file.
void read_points(const CameraJson& json, const std::filesystem::path& folder,
                 const MemoryBudget& budget, TransformsDataset& dataset) {
  const std::optional<glm::dmat4> applied = json.maybe_affine("applied_transform");
  if (const std::string name = json.text("ply_file_path"); !name.empty()) {
    std::filesystem::path file;
    try {
      file = resolve_name_from_folder(folder, name);
    } catch (const UriError& error) {
      json.fail("ply_file_path: " + error.reason);
    }
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
      dataset.remarks.push_back({&remarks::points_missing, {{"file", name}}});
      return;
    }
    Input input = Input::open(file, budget);
    dataset.points = read_points_ply(input);
    return;
  }
  const std::optional<std::filesystem::path> model = colmap_folder(folder);
  if (!applied || !model) return;
  dataset.points = read_colmap_points(*model, budget);
  for (DatasetPoint& point : dataset.points) {
    point.position = glm::dvec3(*applied * glm::dvec4(point.position, 1));
    for (int i = 0; i < 3; ++i)
      if (!std::isfinite(point.position[i]))
        json.fail("applied_transform maps a point to infinity");
  }
}

}  // namespace

TransformsDataset read_transforms_dataset(const std::filesystem::path& path, int images_folder,
                                          const MemoryBudget& budget) {
  Input input = Input::open(path, budget);
  const nlohmann::json root = read_json(input);
  const auto fail = [&](std::size_t frame, const std::string& reason,
                        const std::string& hint = {}) {
    throw InputError({input.name()}, "frame " + std::to_string(frame) + ": " + reason, hint);
  };
  if (!root.is_object() || !root.contains("frames"))
    throw InputError({input.name()}, "it has no \"frames\": not a transforms.json");
  TransformsDataset dataset;
  std::vector<DatasetFrame>& result = dataset.frames;
  for (const TransformsFrame& frame : read_transforms(root, input.name())) {
    const std::size_t number = result.size();
    if (frame.file_path.empty()) fail(number, "file_path is missing");
    if (!frame.other_lens.empty())
      fail(number,
           "the lens (" + frame.other_lens + ") is not described by k1, k2, k3, p1 and p2 alone",
           "undistort the images first");
    const std::optional<std::string> file = in_folder("images", frame.file_path, images_folder);
    if (!file)
      fail(number, "\"" + frame.file_path + "\" is not in images/, so there is none in images_" +
                       std::to_string(images_folder) + "/");
    DatasetFrame made;
    made.name = frame.file_path;
    made.folder = path.parent_path();
    made.file = *file;
    if (frame.width && frame.height) made.size = glm::ivec2(*frame.width, *frame.height);
    made.camera = [frame](int width, int height) { return pinhole(frame, width, height); };
    made.lens = frame.lens;
    // Folders of smaller masks are named like those of smaller images.
    if (!frame.mask_path.empty())
      made.mask = in_folder("masks", frame.mask_path, images_folder).value_or(frame.mask_path);
    made.view_from_world = frame.view_from_world;
    result.push_back(std::move(made));
  }
  read_points(CameraJson({.object = root, .file = input.name(), .where = ""}), path.parent_path(),
              budget, dataset);
  return dataset;
}

}  // namespace tureen
