#include <algorithm>

#include "formats/sog/sog.hpp"
#include "formats/sog/sog_levels.hpp"
#include "formats/sog/sog_meta.hpp"

namespace tureen {

namespace {

class Needs {
 public:
  Needs(const std::filesystem::path& path, const ReadOptions& options)
      : files_(path), options_(options) {}

  SogNeeds all() {
    if (files_.has("lod-meta.json") && !files_.has("meta.json"))
      add_level();
    else
      add_part("meta.json");
    auto& missing = needs_.missing;
    std::sort(missing.begin(), missing.end());
    missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
    return std::move(needs_);
  }

 private:
  bool add(const std::string& name) {
    if (files_.has(name)) return true;
    if (files_.may_gain(name)) needs_.missing.push_back(name);
    return false;
  }

  void add_part(const std::string& name) {
    if (!add(name)) return;
    const SogMeta meta = read_sog_meta(files_, name, SogImages::may_lack);
    for (const std::string& image :
         {meta.means_low, meta.means_high, meta.scales, meta.rotations, meta.colors})
      add(meta.folder + image);
    if (!meta.palette) return;
    add(meta.folder + meta.palette->entries);
    add(meta.folder + meta.palette->indices);
  }

  void add_level() {
    const SogLevels levels = read_sog_levels(files_);
    for (const auto& ranges : levels.levels) {
      std::uint64_t& splats = needs_.levels.emplace_back(0);
      for (const SogLevels::Range& range : ranges) splats += range.count;
    }
    const std::size_t last = needs_.levels.size() - 1;
    std::size_t& level = needs_.level;
    if (options_.lod) {
      level = std::min(*options_.lod, last);  // the reader reports one that does not exist
    } else {
      const std::uint64_t most = options_.max_splats.value_or(needs_.levels[0]);
      while (level < last && (needs_.levels[level] == 0 || needs_.levels[level] > most)) ++level;
    }
    if (!levels.environment.empty()) add_part(levels.environment);
    std::vector<bool> is_added(levels.filenames.size());
    for (const SogLevels::Range& range : levels.levels[level]) {
      if (!is_added[range.file]) add_part(levels.filenames[range.file]);
      is_added[range.file] = true;
    }
  }

  SogFiles files_;
  const ReadOptions& options_;
  SogNeeds needs_;
};

}  // namespace

SogNeeds sog_needs(const std::filesystem::path& path, const ReadOptions& options) {
  return Needs(path, options).all();
}

}  // namespace tureen
