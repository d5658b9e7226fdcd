// A .glb or .gltf, by this program in all its kinds, or by others.
#include "formats/gltf_file.hpp"
#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void gltf(Bytes bytes) {
  static const Scratch empty("gltf");
  Input input = Input::memory("fuzz.glb", bytes);
  require_whole(read_gltf_or_glb(input, empty.folder()));
}

}  // namespace tureen::fuzz
