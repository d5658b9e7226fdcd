// The first bytes of a file, while it arrives.
#include "formats/scene_preview.hpp"
#include "formats/tureen_glb/early_texels.hpp"
#include "tests/fuzz/scratch.hpp"
#include "tests/support/inflated.hpp"

namespace tureen::fuzz {

namespace {

/// As the page's loader does.
void decode_early(Bytes bytes, const char* name) {
  const std::vector<TexelStrip> strips = texel_strips(bytes, name);
  std::uint64_t texel_bytes = 0;
  for (const TexelStrip& strip : strips) texel_bytes += strip.texel_bytes();
  if (texel_bytes > std::uint64_t(64) << 20) return;
  EarlyTexels early(strips);
  for (const TexelStrip& strip : strips) {
    const FileRange range = strip.range();
    if (range.end() > bytes.size()) return;
    const auto images = deflated_strip(strip, bytes.subspan(range.offset, range.size));
    if (!images) return;
    auto low = test::inflated(images->low), high = test::inflated(images->high);
    if (!early.add(images->low.width, low, high)) return;
  }
}

}  // namespace

void preview(Bytes bytes) {
  for (const char* name : {"fuzz.glb", "fuzz.splat"}) {
    preview_size(bytes, name, bytes.size() / 2);
    if (const auto scene = read_preview(bytes, name)) require_whole(*scene);
    decode_early(bytes, name);
  }
}

}  // namespace tureen::fuzz
