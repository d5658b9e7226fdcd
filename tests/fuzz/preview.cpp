// The first bytes of a GLB in our format, while it arrives.
#include "formats/tureen_glb/tureen_glb_preview.hpp"
#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void preview(Bytes bytes) {
  tureen_glb_preview_size(bytes, "fuzz.glb");
  if (const auto scene = read_tureen_glb_preview(bytes, "fuzz.glb")) require_whole(*scene);
}

}  // namespace tureen::fuzz
