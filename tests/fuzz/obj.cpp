// The OBJ of a MobileNeRF shape.
#include "formats/mesh/obj.hpp"

#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void obj(Bytes bytes) {
  Input input = Input::memory("fuzz.obj", bytes);
  read_obj(input);
}

}  // namespace tureen::fuzz
