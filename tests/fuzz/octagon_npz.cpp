// An octagon mesh: a zip archive of arrays of NumPy.
#include "formats/splat/octagon_npz.hpp"

#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void octagon_npz(Bytes bytes) {
  is_octagon_npz(bytes);
  require_whole(read_octagon_npz(Input::memory("fuzz.npz", bytes)));
}

}  // namespace tureen::fuzz
