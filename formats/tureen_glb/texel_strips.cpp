#include "formats/tureen_glb/texel_strips.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <optional>
#include <utility>

#include "formats/tureen_glb/tureen_glb.hpp"
#include "formats/tureen_glb/tureen_glb_geometry.hpp"
#include "formats/tureen_glb/tureen_glb_layout.hpp"
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

FileRange next_image_range(const GlbArrays& arrays, const JsonView& reference, std::uint64_t& end) {
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
  std::vector<TexelStrip> strips;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonView view = list.at(i), images = view["images"];
    if (view["first"].natural() != counted)
      view["first"].fail("expected " + std::to_string(counted));
    if (images.size() != 2) images.fail("expected two images");
    TexelStrip strip;
    strip.texels = std::size_t(view["count"].natural(glb_layout::strip_texels));
    strip.low = next_image_range(arrays, images.at(0), images_end);
    strip.high = next_image_range(arrays, images.at(1), images_end);
    counted += strip.texels;
    encoded += strip.low.size + strip.high.size;
    strips.push_back(strip);
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

std::optional<DeflatedStrip> deflated_strip(const TexelStrip& strip,
                                            std::span<const std::byte> bytes) {
  assert(bytes.size() == strip.range().size);
  const auto image = [&](const FileRange& range) {
    const auto first = std::size_t(range.offset - strip.low.offset);
    return deflated_png(bytes.subspan(first, std::size_t(range.size)));
  };
  auto low = image(strip.low), high = image(strip.high);
  if (!low || !high || low->width != high->width || low->height != high->height)
    return std::nullopt;
  // A taller image could take any memory.
  const auto width = std::size_t(low->width);
  if (std::size_t(low->height) != (strip.texels + width - 1) / width) return std::nullopt;
  return DeflatedStrip{std::move(*low), std::move(*high)};
}

EarlyTexels::EarlyTexels(std::vector<TexelStrip> strips) : strips_(std::move(strips)) {
  std::size_t bytes = 0;
  for (const TexelStrip& strip : strips_) bytes += strip.texel_bytes();
  texels_.reserve(bytes);
}

bool EarlyTexels::add(int width, std::span<std::byte> low, std::span<std::byte> high) {
  assert(width > 0 && added_ < strips_.size());
  const std::size_t row_pixels = std::size_t(width), row_bytes = png_row_bytes(width);
  std::size_t left = strips_[added_].texels;
  const std::size_t needed = (left + row_pixels - 1) / row_pixels * row_bytes;
  if (is_broken_ || std::min(low.size(), high.size()) < needed ||
      !unfilter(low.first(needed), width) || !unfilter(high.first(needed), width)) {
    is_broken_ = true;
    return false;
  }
  const auto pixels = [](const std::byte* row, std::size_t count) {
    return std::span(reinterpret_cast<const glm::u8vec4*>(row + 1), count);
  };
  for (std::size_t at = 0; left > 0; at += row_bytes) {
    const std::size_t count = std::min(left, row_pixels);
    append_texels(pixels(&low[at], count), pixels(&high[at], count), texels_);
    left -= count;
  }
  ++added_;
  return true;
}

std::size_t EarlyTexels::decoded_of(std::span<const TexelStrip> strips) const {
  return std::equal(strips.begin(), strips.end(), strips_.begin(), strips_.end()) ? added_ : 0;
}

}  // namespace tureen
