// One file of a streamed SOG beside valid others. The first byte selects the file.
#include "formats/sog/sog.hpp"
#include "tests/fuzz/folder_files.hpp"
#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void sog_folder(Bytes bytes) {
  if (bytes.empty()) return;
  static ScratchFiles files("sog", sog_files());
  files.replace(std::to_integer<std::size_t>(bytes[0]), bytes.subspan(1));
  require_whole(read_sog(files.folder()));
}

}  // namespace tureen::fuzz
