// An OBJ, and the OBJ of a MobileNeRF shape.
#include "formats/mesh/obj.hpp"

#include <cstdlib>

#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void obj(Bytes bytes) {
  const auto try_to = [&](auto&& read) {
    Input input = Input::memory("fuzz.obj", bytes);
    try {
      read(input);
    } catch (const InputError&) {  // the next reader may accept the bytes
    }
  };
  try_to([](Input& input) { read_obj(input, {.only_uv = true}); });
  Input input = Input::memory("fuzz.obj", bytes);
  const ObjMesh mesh = read_obj(input);
  for (const glm::uvec3& triangle : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      if (triangle[k] >= mesh.positions.size()) std::abort();
}

}  // namespace tureen::fuzz
