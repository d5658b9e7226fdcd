// The part of a file that gives a preview of it (formats/scene_preview.hpp).
#pragma once

#include <cstdint>

namespace tureen {

struct PreviewSize {
  std::uint64_t bytes = 0;  // leading bytes of the file; 0 if there is no (further) preview
  bool has_splats = false;  // otherwise it shows a soup
};

}  // namespace tureen
