#include "formats/dataset/near_files.hpp"

#include <utf8proc.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "base/suggestion.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

/// The last ones are not supported; a photograph that has one is found, to name what it is.
constexpr const char* suffixes_of_images[] = {".png",  ".jpg",  ".jpeg", ".webp", ".heic",
                                              ".heif", ".avif", ".tif",  ".tiff"};

/// A dataset has thousands of photographs; a name that leads into a whole disk is not searched.
constexpr std::size_t max_files = 200'000;
constexpr int max_depth = 8;

/// The text without case, its letters decomposed. Bytes that are not UTF-8 stay.
std::string folded(const std::string& text) {
  utf8proc_uint8_t* mapped = nullptr;
  const utf8proc_ssize_t size = utf8proc_map(
      reinterpret_cast<const utf8proc_uint8_t*>(text.data()), utf8proc_ssize_t(text.size()),
      &mapped, utf8proc_option_t(UTF8PROC_STABLE | UTF8PROC_DECOMPOSE | UTF8PROC_CASEFOLD));
  const std::unique_ptr<utf8proc_uint8_t, decltype(&std::free)> owner(mapped, &std::free);
  if (size < 0) return text;
  return {reinterpret_cast<const char*>(mapped), std::size_t(size)};
}

struct FoldedName {
  std::vector<std::string> parts;
  std::string suffix;
};

FoldedName folded_name(std::string name, std::span<const char* const> suffixes) {
  std::replace(name.begin(), name.end(), '\\', '/');
  FoldedName result;
  for (const fs::path& part : fs::path(folded(name)).relative_path()) {
    const std::string text = part.string();
    if (text == "..")
      result.parts.clear();
    else if (text != "." && !text.empty() && !text.ends_with(':'))
      result.parts.push_back(text);
  }
  if (result.parts.empty()) return result;
  std::string& file = result.parts.back();
  const std::string suffix = fs::path(file).extension().string();
  // "r_0.5" has no suffix.
  if (std::any_of(suffixes.begin(), suffixes.end(), [&](const char* s) { return suffix == s; })) {
    file.resize(file.size() - suffix.size());
    result.suffix = suffix;
  }
  return result;
}

/// Whether one of the paths ends with the other.
bool ends_alike(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return std::equal(a.rbegin(), a.rbegin() + std::ptrdiff_t(std::min(a.size(), b.size())),
                    b.rbegin());
}

bool is_mask_folder(const std::string& part) { return part.find("mask") != part.npos; }

/// Whether a folder of masks leads to `parts`.
bool is_mask(const std::vector<std::string>& parts) {
  return std::any_of(parts.begin(), parts.end() - 1, is_mask_folder);
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

}  // namespace

const std::span<const char* const> image_suffixes = suffixes_of_images;

const NearFiles::Folder& NearFiles::listed(const fs::path& folder) {
  const auto [at, is_new] = folders_.try_emplace(folder);
  Folder& list = at->second;
  if (!is_new) return list;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder.empty() ? fs::path(".") : folder,
                                         fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry.depth() >= max_depth) entry.disable_recursion_pending();
    if (!is_file(entry->path())) continue;
    if (list.files.size() == max_files) break;
    const fs::path relative = entry->path().lexically_relative(folder.empty() ? "." : folder);
    FoldedName name = folded_name(relative.string(), {});
    name.suffix = fs::path(name.parts.back()).extension().string();
    name.parts.back().resize(name.parts.back().size() - name.suffix.size());
    list.by_stem.emplace(name.parts.back(), list.files.size());
    list.files.push_back({entry->path(), std::move(name.parts), std::move(name.suffix)});
  }
  return list;
}

std::optional<NearFiles::Found> NearFiles::find(const fs::path& folder, const std::string& name,
                                                std::span<const char* const> suffixes) {
  if (name.empty() || name.find('\0') != name.npos) return std::nullopt;
  if (const fs::path exact = folder / name; is_file(exact)) return Found{exact};
  const FoldedName wanted = folded_name(name, suffixes);
  if (wanted.parts.empty()) return std::nullopt;
  if (wanted.suffix.empty())
    for (const char* suffix : suffixes)
      if (const fs::path completed = folder / (name + suffix); is_file(completed))
        return Found{completed};

  const Folder& list = listed(folder);
  const auto [first, last] = list.by_stem.equal_range(wanted.parts.back());
  std::vector<const File*> fitting;
  for (auto at = first; at != last; ++at) {
    const File& file = list.files[at->second];
    const bool has_suffix = std::any_of(suffixes.begin(), suffixes.end(),
                                        [&](const char* suffix) { return file.suffix == suffix; });
    if (has_suffix && ends_alike(file.parts, wanted.parts) &&
        is_mask(file.parts) == is_mask(wanted.parts))
      fitting.push_back(&file);
  }
  // If several fit, prefer those in the folders of the name, then those with its suffix.
  const auto prefer = [&](const auto& is_better) {
    std::vector<const File*> better;
    std::copy_if(fitting.begin(), fitting.end(), std::back_inserter(better), is_better);
    if (!better.empty()) fitting = std::move(better);
  };
  prefer([&](const File* file) { return file->parts == wanted.parts; });
  prefer([&](const File* file) { return file->suffix == wanted.suffix; });
  if (fitting.size() != 1) return std::nullopt;
  // A suffix that the name lacks, in upper case, is what NeRF-synthetic's readers add.
  const bool is_exact = wanted.suffix.empty() &&
                        (folder / name).lexically_normal() ==
                            fs::path(fitting[0]->path).replace_extension().lexically_normal();
  return Found{fitting[0]->path, is_exact};
}

std::string NearFiles::nearest(const fs::path& folder, const std::string& name) {
  std::vector<std::string> names;
  for (const File& file : listed(folder).files) names.push_back(file.path.filename().string());
  return tureen::nearest(fs::path(name).filename().string(), names);
}

}  // namespace tureen
