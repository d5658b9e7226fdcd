// A .ksplat.
#include "formats/splat/ksplat.hpp"

#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void ksplat(Bytes bytes) {
  Input input = Input::memory("fuzz.ksplat", bytes);
  require_whole(read_ksplat(input));
}

}  // namespace tureen::fuzz
