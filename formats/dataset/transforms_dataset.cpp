#include "formats/dataset/transforms_dataset.hpp"

#include <nlohmann/json.hpp>

#include "base/input.hpp"
#include "base/json/json_file.hpp"
#include "formats/dataset/transforms_json.hpp"

namespace tureen {

namespace {

/// "./images/a.jpg" as "images_4/a.jpg"; nullopt if the name begins with another folder.
std::optional<std::string> in_images_folder(const std::string& name, int images_folder) {
  if (images_folder == 1) return name;
  const std::string_view rest = std::string_view(name).substr(name.starts_with("./") ? 2 : 0);
  constexpr std::string_view images = "images/";
  if (!rest.starts_with(images)) return {};
  return "images_" + std::to_string(images_folder) + "/" + std::string(rest.substr(images.size()));
}

}  // namespace

std::vector<DatasetFrame> read_transforms_dataset(const std::filesystem::path& path,
                                                  int images_folder, const MemoryBudget& budget) {
  Input input = Input::open(path, budget);
  const nlohmann::json root = read_json(input);
  const auto fail = [&](std::size_t frame, const std::string& reason,
                        const std::string& hint = {}) {
    throw InputError({input.name(), {}, {}}, "frame " + std::to_string(frame) + ": " + reason,
                     hint);
  };
  if (!root.is_object() || !root.contains("frames"))
    throw InputError({input.name(), {}, {}}, "it has no \"frames\": not a transforms.json");
  std::vector<DatasetFrame> result;
  for (const TransformsFrame& frame : read_transforms(root, input.name())) {
    const std::size_t number = result.size();
    if (frame.file_path.empty()) fail(number, "file_path is missing");
    if (!frame.other_lens.empty())
      fail(number,
           "the lens (" + frame.other_lens + ") is not described by k1, k2, k3, p1 and p2 alone",
           "undistort the images first");
    const std::optional<std::string> file = in_images_folder(frame.file_path, images_folder);
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
    made.view_from_world = frame.view_from_world;
    result.push_back(std::move(made));
  }
  return result;
}

}  // namespace tureen
