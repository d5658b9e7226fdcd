#include "cli/files/eval_images.hpp"

#include <cctype>
#include <set>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/output.hpp"
#include "cli/files/image_file.hpp"
#include "image/contact_sheet.hpp"
#include "image/heat_map.hpp"
#include "image/specks.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* sheet_name = "contact_sheet.png";
constexpr int thumbnail_side = 640;  // larger than the default: it has four images side by side

/// Throws UsageError if a file in `spared` would be replaced: it may be a photograph.
void check_spared(const fs::path& spared, const fs::path& folder,
                  const std::vector<std::string>& files) {
  if (spared.empty() || folder.empty()) return;
  if (!lies_in(folder, spared)) return;
  std::error_code error;
  for (const std::string& file : files)
    if (fs::exists(folder / file, error))
      throw UsageError(
          (folder / file).string() + " exists; eval does not replace files in the dataset's folder",
          "choose another folder with -o");
}

}  // namespace

std::vector<std::string> image_names(std::span<const Photograph> photographs) {
  std::set<std::string> taken{sheet_name};
  std::vector<std::string> names;
  for (const Photograph& photograph : photographs) {
    fs::path path = fs::path(photograph.camera.name).lexically_normal();
    std::string stem = path.replace_extension().string();
    for (char& c : stem)
      if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
    // A leading dot would hide the file.
    stem.erase(0, stem.find_first_not_of("._"));
    if (stem.empty()) stem = "view";
    std::string name = stem + ".png";
    for (int n = 2; !taken.insert(name).second; ++n) name = stem + "_" + std::to_string(n) + ".png";
    names.push_back(name);
  }
  return names;
}

EvalImages::EvalImages(const fs::path& folder, const fs::path& spared,
                       std::span<const Photograph> photographs)
    : folder_(folder), names_(image_names(photographs)), thumbnails_(photographs.size()) {
  check_spared(spared, folder, names_);
  make_folder(folder);
}

void EvalImages::write(std::size_t view, const ImageF& photograph, const ImageF& rendering) {
  const Image8 images[] = {quantised(photograph), quantised(rendering),
                           difference(photograph, rendering),
                           marked_defects(photograph, rendering)};
  Image8 image = side_by_side(images);
  // The photograph is already composited over the background.
  for (glm::u8vec4& pixel : image.pixels) pixel.a = 255;
  write_image(image, folder_ / names_[view]);
  thumbnails_[view] = thumbnail(image, thumbnail_side);
}

std::vector<std::string> EvalImages::finish() {
  std::vector<std::string> files;
  for (const std::string& name : names_) files.push_back((folder_ / name).string());
  if (names_.size() == 1) return files;
  const fs::path sheet = folder_ / sheet_name;
  write_image(contact_sheet(thumbnails_, thumbnail_side), sheet);
  files.push_back(sheet.string());
  return files;
}

}  // namespace tureen::cli
