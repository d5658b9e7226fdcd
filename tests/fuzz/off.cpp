// An OFF or COFF.
#include "formats/mesh/off.hpp"

#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void off(Bytes bytes) {
  Input input = Input::memory("fuzz.off", bytes);
  require_whole(read_off(input));
}

}  // namespace tureen::fuzz
