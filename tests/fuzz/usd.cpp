// A .usda, or a .usdz.
#include "formats/usd/usd.hpp"

#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void usd(Bytes bytes) {
  is_usd(bytes);
  require_whole(read_usd(Input::memory("fuzz.usda", bytes)));
}

}  // namespace tureen::fuzz
