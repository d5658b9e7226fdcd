// The coded texels of a slim file. The first byte is the number of faces.
#include "formats/tureen_glb/slim_texels.hpp"

#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void slim_texels(Bytes bytes) {
  if (bytes.empty()) return;
  decode_slim_texels(bytes.subspan(1), std::to_integer<std::size_t>(bytes[0]), "fuzz.glb");
}

}  // namespace tureen::fuzz
