// One file of a DiffSoup export beside valid others. The first byte selects the file.
#include "formats/diffsoup/diffsoup_export.hpp"
#include "tests/fuzz/folder_files.hpp"
#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void diffsoup(Bytes bytes) {
  if (bytes.empty()) return;
  static ScratchFiles files("diffsoup", diffsoup_files());
  files.replace(std::to_integer<std::size_t>(bytes[0]), bytes.subspan(1));
  require_whole(read_diffsoup_export(files.folder()));
}

}  // namespace tureen::fuzz
