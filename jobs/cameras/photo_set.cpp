#include "jobs/cameras/photo_set.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/extension.hpp"
#include "base/input.hpp"
#include "image/codecs/exif.hpp"
#include "image/png.hpp"
#include "jobs/cameras/camera_remarks.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

/// Also those that Tureen does not read: each costs a remark, not silence.
bool has_image_name(const fs::path& path) {
  constexpr std::array names{".jpg",  ".jpeg", ".png",  ".webp", ".heic",
                             ".heif", ".avif", ".tiff", ".tif"};
  const std::string extension = extension_of(path);
  return std::find(names.begin(), names.end(), extension) != names.end() &&
         !path.filename().string().starts_with('.');  // macOS writes ._NAME beside files
}

std::vector<fs::path> images_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (has_image_name(at->path()) && at->is_regular_file(error)) files.push_back(at->path());
  return files;
}

/// Text that orders names as people do: before each number, its number of digits without zeros in
/// front.
std::string sort_key(std::string_view name) {
  std::string key;
  for (std::size_t i = 0; i < name.size();) {
    const std::size_t end = std::min(name.find_first_not_of("0123456789", i), name.size());
    if (i == end) {
      key += name[i++];
      continue;
    }
    i = std::min(name.find_first_not_of('0', i), end - 1);
    key += '0';  // a digit, where one stood
    key += char(std::min<std::size_t>(end - i, 127));
    key += name.substr(i, end - i);
    i = end;
  }
  return key;
}

/// Reads size and focal length from the header; from all of the file if a long EXIF block precedes
/// the header.
void read_header(PhotoFile& photo) {
  constexpr std::size_t beginning = 1 << 18;
  Input input = Input::open(photo.path);
  photo.bytes = input.size();
  std::vector<std::byte> bytes(std::size_t(std::min<std::uint64_t>(input.size(), beginning)));
  input.read(bytes, "the image");
  photo.focal_mm = exif_focal_length(bytes);
  try {
    photo.size = image_size(bytes, photo.path.string());
  } catch (const InputError&) {
    if (input.remaining() == 0) throw;
    input.seek(0);
    photo.size = image_size(input.read_rest(), photo.path.string());
  }
}

void leave_out_copies(PhotoSet& set) {
  std::multimap<std::uint64_t, fs::path> kept;  // by size in bytes
  std::vector<std::string> copies;
  const auto is_copy = [&](const PhotoFile& photo) {
    const auto [first, last] = kept.equal_range(photo.bytes);
    const bool found = std::any_of(first, last, [&](const auto& other) {
      return Input::open(photo.path).read_rest() == Input::open(other.second).read_rest();
    });
    if (found)
      copies.push_back(photo.name);
    else
      kept.emplace(photo.bytes, photo.path);
    return found;
  };
  std::erase_if(set.photos, is_copy);
  if (copies.empty()) return;
  const std::size_t count = copies.size();
  copies.resize(std::min<std::size_t>(count, 3));
  set.remarks.push_back({&remarks::photographs_copied, {{"count", count}, {"names", copies}}});
}

void give_names(PhotoSet& set) {
  std::set<std::string> taken;
  for (PhotoFile& photo : set.photos) {
    photo.name = photo.path.filename().string();
    for (char& c : photo.name)
      if (std::isspace(static_cast<unsigned char>(c))) c = '_';
    while (!taken.insert(photo.name).second) photo.name = "_" + photo.name;
  }
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  return std::pair(sort_key(a), a) < std::pair(sort_key(b), b);
}

std::optional<fs::path> folder_of_photographs(const fs::path& folder) {
  for (const fs::path& candidate : {folder, folder / "images", folder / "input"})
    if (!images_in(candidate).empty()) return candidate;
  return std::nullopt;
}

PhotoSet find_photographs(const fs::path& folder, const std::function<void(double)>& progress) {
  require_there(folder);
  PhotoSet set;
  std::vector<fs::path> files = images_in(folder);
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  std::optional<InputError> first_failure;
  for (std::size_t i = 0; i < files.size(); ++i) {
    progress(double(i) / double(files.size()));
    PhotoFile photo{.path = files[i]};
    try {
      read_header(photo);
      set.photos.push_back(std::move(photo));
    } catch (const InputError& error) {
      set.remarks.push_back({&remarks::photograph_unreadable,
                             {{"name", files[i].filename().string()}, {"reason", error.reason()}}});
      if (!first_failure) first_failure = error;
    }
  }
  if (set.photos.empty()) {
    if (first_failure) throw InputError(*first_failure);
    throw InputError({folder.string()},
                     fs::is_directory(folder) ? "the folder has no photographs"
                                              : "is neither a folder nor a video",
                     "pass a folder of PNG, JPEG or WebP images, or a video");
  }
  give_names(set);
  leave_out_copies(set);
  return set;
}

std::vector<PhotoGroup> camera_groups(const PhotoSet& set) {
  std::map<std::tuple<int, int, long>, PhotoGroup> groups;
  for (std::size_t i = 0; i < set.photos.size(); ++i) {
    const PhotoFile& photo = set.photos[i];
    // Cameras round focal lengths to hundredths of a millimetre or coarser.
    const long focal = photo.focal_mm ? std::lround(100 * *photo.focal_mm) : 0;
    PhotoGroup& group = groups[{photo.size.x, photo.size.y, focal}];
    group.size = photo.size;
    group.photos.push_back(i);
  }
  std::vector<PhotoGroup> result;
  for (auto& [key, group] : groups) result.push_back(std::move(group));
  return result;
}

}  // namespace tureen
