// The material library of an OBJ.
#include "formats/mesh/mtl.hpp"

#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void mtl(Bytes bytes) {
  Input input = Input::memory("fuzz.mtl", bytes);
  read_mtl(input);
}

}  // namespace tureen::fuzz
