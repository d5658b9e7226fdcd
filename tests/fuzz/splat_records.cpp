// A .splat: records without a header.
#include "formats/splat/splat_records.hpp"

#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void splat_records(Bytes bytes) {
  Input input = Input::memory("fuzz.splat", bytes);
  require_whole(read_splat_records(input));
}

}  // namespace tureen::fuzz
