// A zip archive and the content of its entries.
#include <algorithm>

#include "formats/archive/zip_archive.hpp"
#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void zip(Bytes bytes) {
  ZipArchive archive(Input::memory("fuzz.zip", bytes));
  for (const ZipEntry& entry : archive.entries()) archive.read_all(entry, 1 << 20);
}

}  // namespace tureen::fuzz
