// lod-meta.json of a streamed SOG: which splats of which files each level of detail has.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/sog/sog_files.hpp"

namespace tureen {

struct SogLevels {
  struct Range {
    std::uint32_t file = 0;  // index into `filenames`
    std::uint64_t offset = 0, count = 0;
  };
  std::vector<std::string> filenames = {};  // of meta.json
  std::string environment = {};             // of all levels; "": none
  /// By level, from the finest on; in the order of the tree.
  std::vector<std::vector<Range>> levels = {};
};

/// Reads lod-meta.json, also without version and counts, as older programs write it. Throws
/// InputError.
SogLevels read_sog_levels(SogFiles& files);

}  // namespace tureen
