// The coded triangles of a compressed file. The first two bytes are the numbers of faces and
// vertices.
#include "formats/tureen_glb/compressed_geometry.hpp"

#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void compressed_geometry(Bytes bytes) {
  if (bytes.size() < 2) return;
  const auto count = [&](std::size_t i) { return std::to_integer<std::size_t>(bytes[i]); };
  decode_compressed_geometry(bytes.subspan(2), count(1), count(0), "fuzz.glb");
}

}  // namespace tureen::fuzz
