// The photographs of a folder, before their cameras are known.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/remark.hpp"

namespace tureen {

struct PhotoFile {
  std::filesystem::path path;
  /// Its name in the dataset: that of the file, with '_' for each white space, which lists of
  /// COLMAP cannot hold; unique.
  std::string name = {};
  std::uint64_t bytes = 0;
  glm::ivec2 size{0};                   // pixels, as stored
  std::optional<double> focal_mm = {};  // from EXIF
};

struct PhotoSet {
  std::vector<PhotoFile> photos = {};  // in the order of natural_less()
  std::vector<Remark> remarks = {};    // photographs that were left out
};

/// Orders names by their text and their numbers: photo_2 precedes photo_10.
bool natural_less(std::string_view a, std::string_view b);

/// The folder of the photographs: `folder` itself, or its folder images or input; nullopt if none
/// has an image. Opens no file.
std::optional<std::filesystem::path> folder_of_photographs(const std::filesystem::path& folder);

/// Reads the headers of all photographs in `folder`, without its subfolders. Leaves out files that
/// are no images that Tureen reads, and copies of another photograph, byte by byte. `progress`:
/// called with the fraction done; may throw. Throws InputError if no photograph is left.
PhotoSet find_photographs(const std::filesystem::path& folder,
                          const std::function<void(double)>& progress);

/// Photographs that share a camera: one size, one focal length.
struct PhotoGroup {
  glm::ivec2 size{0};
  std::vector<std::size_t> photos;  // indices of PhotoSet::photos
};
std::vector<PhotoGroup> camera_groups(const PhotoSet& set);

}  // namespace tureen
