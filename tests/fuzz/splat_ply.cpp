// A PLY with splats, of every kind.
#include "formats/ply_file.hpp"
#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void splat_ply(Bytes bytes) {
  Input input = Input::memory("fuzz.ply", bytes);
  require_whole(read_ply(input));
}

}  // namespace tureen::fuzz
