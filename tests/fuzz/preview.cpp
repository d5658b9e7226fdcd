// The first bytes of a file, while it arrives.
#include "formats/early_texels.hpp"
#include "formats/scene_preview.hpp"
#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void preview(Bytes bytes) {
  for (const char* name : {"fuzz.glb", "fuzz.splat"}) {
    preview_size(bytes, name, bytes.size() / 2);
    if (const auto scene = read_preview(bytes, name)) require_whole(*scene);
    for (const TexelStrip& strip : texel_strips(bytes, name)) {
      const FileRange range = strip.range();
      if (range.end() <= bytes.size())
        decode_strip(strip, bytes.subspan(range.offset, range.size), name);
    }
  }
}

}  // namespace tureen::fuzz
