// The coded texels of a compressed file. The first byte is the number of faces.
#include "formats/tureen_glb/compressed_texels.hpp"

#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void compressed_texels(Bytes bytes) {
  if (bytes.empty()) return;
  decode_compressed_texels(bytes.subspan(1), std::to_integer<std::size_t>(bytes[0]), "fuzz.glb");
}

}  // namespace tureen::fuzz
