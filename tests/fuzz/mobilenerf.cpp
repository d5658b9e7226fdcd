// One file of a MobileNeRF scene beside valid others. The first byte selects the file.
#include "formats/mesh/mobilenerf.hpp"

#include "tests/fuzz/folder_files.hpp"
#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void mobilenerf(Bytes bytes) {
  if (bytes.empty()) return;
  static ScratchFiles files("mobilenerf", mobilenerf_files());
  files.replace(std::to_integer<std::size_t>(bytes[0]), bytes.subspan(1));
  is_mobilenerf(files.folder());
  require_whole(read_mobilenerf(files.folder()));
}

}  // namespace tureen::fuzz
