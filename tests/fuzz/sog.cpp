// A SOG in a zip archive.
#include "formats/sog/sog.hpp"

#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void sog(Bytes bytes) {
  is_sog("fuzz.sog", bytes);
  require_whole(read_sog_archive(Input::memory("fuzz.sog", bytes)));
}

}  // namespace tureen::fuzz
