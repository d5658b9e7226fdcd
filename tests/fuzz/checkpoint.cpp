// A checkpoint by torch: the zip archive, its pickle and its tensors.
#include "formats/torch/checkpoint.hpp"

#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void checkpoint(Bytes bytes) { require_whole(read_checkpoint(Input::memory("fuzz.pt", bytes))); }

}  // namespace tureen::fuzz
