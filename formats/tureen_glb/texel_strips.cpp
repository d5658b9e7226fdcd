#include "formats/tureen_glb/texel_strips.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "base/error.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "formats/tureen_glb/tureen_glb_geometry.hpp"
#include "image/png.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

namespace {

constexpr std::size_t texel_bytes = LatticeTexture::channels;

/// The extension of the only layer, if there is one.
std::optional<JsonView> only_layer_extension(const GlbArrays& arrays) {
  const JsonView root = tureen_extension_of(arrays);
  if (!has_layers(root)) return root;
  if (root["layers"].size() != 1) return std::nullopt;
  const JsonView node = arrays.root()["nodes"].at(GlbArrays::index(root["layers"].at(0)));
  return node["extensions"][tureen_extension];
}

}  // namespace

FileRange image_range(const GlbArrays& arrays, const JsonView& reference) {
  const JsonView image = arrays.root()["images"].at(GlbArrays::index(reference));
  return arrays.view_location(image["bufferView"]);
}

FileRange next_image_range(const GlbArrays& arrays, const JsonView& reference,
                           std::uint64_t& end) {
  const FileRange range = image_range(arrays, reference);
  if (range.offset < end) reference.fail("begins before the end of the previous image");
  end = range.end();
  return range;
}

std::vector<TexelStrip> texel_strips(const GlbArrays& arrays, const JsonView& appearance,
                                     std::uint64_t& images_end) {
  const JsonView list = appearance["strips"];
  const std::uint64_t texels = appearance["texel_count"].natural(GlbArrays::max_count);
  // Strips are bounded and contiguous. Deflate compresses by at most 1032 : 1, so a count that
  // exceeds the images is rejected before any allocation.
  std::uint64_t counted = 0, encoded = 0;
  std::vector<TexelStrip> strips(list.size());
  for (std::size_t i = 0; i < strips.size(); ++i) {
    const JsonView strip = list.at(i), images = strip["images"];
    if (strip["first"].natural() != counted)
      strip["first"].fail("expected " + std::to_string(counted));
    strips[i].texels = std::size_t(strip["count"].natural(glb_layout::strip_texels));
    counted += strips[i].texels;
    if (images.size() != 2) images.fail("expected two images");
    strips[i].low = next_image_range(arrays, images.at(0), images_end);
    strips[i].high = next_image_range(arrays, images.at(1), images_end);
    encoded += strips[i].low.size + strips[i].high.size;
  }
  if (counted != texels)
    list.fail("its strips hold " + std::to_string(counted) + " texels, expected " +
              std::to_string(texels));
  if (texels * texel_bytes / 1032 > encoded)
    list.fail(std::to_string(texels) + " texels are more than its images can hold");
  return strips;
}

void append_texels(std::span<const glm::u8vec4> low, std::span<const glm::u8vec4> high,
                   std::vector<std::uint8_t>& texels) {
  // In blocks: a larger vector would first be filled with zeros, which takes as long as the rest.
  std::array<std::uint8_t, 1024 * texel_bytes> block;
  for (std::size_t done = 0; done < low.size();) {
    std::uint8_t* end = block.data();
    for (; done < low.size() && end != block.data() + block.size(); ++done, end += texel_bytes) {
      std::memcpy(end, &low[done], 4);
      std::memcpy(end + 4, &high[done], 4);
    }
    texels.insert(texels.end(), block.data(), end);
  }
}

std::vector<TexelStrip> texel_strips(std::span<const std::byte> prefix, const std::string& name) {
  Input input = Input::memory(name, prefix);
  if (!is_glb(input)) return {};
  const std::optional<GlbContainer> glb = read_glb_beginning(input);
  if (!glb || !is_tureen_glb(*glb)) return {};
  const GlbArrays arrays(input, *glb);
  const auto layer = only_layer_extension(arrays);
  const auto appearance = layer ? layer->find("appearance") : std::nullopt;
  if (!appearance || !appearance->find("strips")) return {};
  std::uint64_t images_end = 0;
  return texel_strips(arrays, *appearance, images_end);
}

void decode_strip(const TexelStrip& strip, std::span<const std::byte> bytes,
                  const std::string& name, std::vector<std::uint8_t>& texels) {
  const auto image = [&](const FileRange& range) {
    const auto first = std::size_t(range.offset - strip.low.offset);
    return decode_image(bytes.subspan(first, std::size_t(range.size)), name, MemoryBudget());
  };
  const Image8 low = image(strip.low), high = image(strip.high);
  if (low.pixels.size() < strip.texels || high.pixels.size() < strip.texels)
    throw InputError({name, {}, {}}, "an image has too few pixels");
  append_texels(std::span(low.pixels).first(strip.texels), high.pixels, texels);
}

bool EarlyTexels::begin(std::span<const TexelStrip> all) const {
  return strips.size() <= all.size() && std::equal(strips.begin(), strips.end(), all.begin());
}

}  // namespace tureen
