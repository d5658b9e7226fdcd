#include <cstring>

#include "base/error.hpp"
#include "formats/tureen_glb/compressed_texels_header.hpp"
#include "formats/tureen_glb/compressed_walk.hpp"

namespace tureen {

namespace compressed {

namespace {

std::vector<Middle> middles_of(int level) {
  std::vector<Middle> result;
  const int n = lattice::resolution(level);
  for (int diagonal = 0; diagonal <= n; ++diagonal)
    for (int y = 0; y <= diagonal; ++y) {
      const int x = diagonal - y;
      if (x % 2 == 0 && y % 2 == 0) continue;
      if (y % 2 == 0)
        result.push_back({{x, y}, {x - 1, y}, {x + 1, y}});
      else if (x % 2 == 0)
        result.push_back({{x, y}, {x, y - 1}, {x, y + 1}});
      else
        result.push_back({{x, y}, {x + 1, y - 1}, {x - 1, y + 1}});
    }
  return result;
}

}  // namespace

const std::vector<Middle>& middles(int level) {
  static const auto all = [] {
    std::array<std::vector<Middle>, lattice::max_level + 1> tables;
    for (int l = 1; l <= lattice::max_level; ++l) tables[std::size_t(l)] = middles_of(l);
    return tables;
  }();
  return all[std::size_t(level)];
}

}  // namespace compressed

LatticeTexture decode_compressed_texels(std::span<const std::byte> bytes, std::size_t faces,
                                        const std::string& file, MemoryBudget budget) {
  using namespace compressed;
  const auto damaged = [&]() -> InputError {
    return InputError({file}, "the compressed texels are cut short or damaged");
  };
  // Texel indices have 32 bits.
  const auto limit = std::min<std::uint64_t>(bytes.size() * max_per_byte, 0xffffffffu);
  TexelHeader header;
  if (bytes.size() < sizeof(header) || faces > limit) throw damaged();
  std::memcpy(&header, bytes.data(), sizeof(header));
  if (header.feature_step == 0 || header.alpha_step == 0) throw damaged();

  RangeDecoder coder(bytes.subspan(sizeof(header)));
  const auto take = [&](std::uint64_t count, std::size_t each) {
    if (!budget.take(count, each))
      throw InputError({file}, budget.refusal("the compressed texels"), max_memory_hint);
  };
  take(1, sizeof(Models));
  const auto models = std::make_unique<Models>();
  // Memory per face: an entry of patch_of_face and a Patch, both in growing vectors (times 3), an
  // Activity (36 bytes) and a LatticePatch.
  take(faces, 3 * sizeof(std::uint32_t) + 3 * sizeof(Patch) + 36 + sizeof(LatticePatch));
  Faces layout;
  if (!code_faces(coder, *models, faces, {}, limit, layout)) throw damaged();
  take(layout.texels, channels * (sizeof(std::int16_t) + 2 * sizeof(std::uint8_t)));
  const auto never_asked = [](const Question&, const auto&) { return 0; };
  Walk walk(coder, *models, {.features = header.feature_step, .alpha = header.alpha_step},
            never_asked);
  const std::vector<std::int16_t> values = walk(layout);
  if (coder.exhausted()) throw damaged();

  LatticeTexture texture;
  texture.patches.reserve(faces);
  for (const std::uint32_t p : layout.patch_of_face)
    texture.patches.push_back({layout.patches[p].first_texel, layout.patches[p].level});
  std::vector<std::uint8_t> texels(values.size());
  for (std::size_t t = 0; t < values.size(); t += channels) {
    for (int f = 0; f < alpha; ++f)
      texels[t + std::size_t(f)] =
          header.basis.feature(f, std::span(values).subspan(t, std::size_t(alpha)));
    texels[t + alpha] = std::uint8_t(values[t + alpha]);
  }
  texture.texels = std::move(texels);
  return texture;
}

}  // namespace tureen
