// A PLY, text or binary of either byte order.
#include "formats/ply_file.hpp"
#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void ply(Bytes bytes) {
  Input input = Input::memory("fuzz.ply", bytes);
  require_whole(read_ply(input));
}

}  // namespace tureen::fuzz
