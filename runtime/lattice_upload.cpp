#include "runtime/lattice_upload.hpp"

#include <algorithm>
#include <cstring>
#include <glm/vec2.hpp>

#include "soup/error.hpp"
#include "soup/lattice.hpp"

namespace tureen {

namespace {

/// Where the texels of each slot come from and go to.
class Placement {
 public:
  Placement(const LatticeTexture& texture, const RenderPlan& plan)
      : texture_(texture), plan_(plan) {
    // Without a uniform level and without levels of our own the texels stay as the soup has them.
    repacked_ = plan.lattice.uniform_level >= 0 || !plan.lattice.levels.empty();
    if (!repacked_) {
      texel_count_ = texture.texel_count();
      return;
    }
    first_of_slot_.resize(plan.faces.size());
    for (std::size_t slot = 0; slot < plan.faces.size(); ++slot) {
      first_of_slot_[slot] = texel_count_;
      texel_count_ += lattice::texel_count(level(slot));
    }
  }

  std::uint64_t texel_count() const { return texel_count_; }

  int level(std::size_t slot) const {
    if (!plan_.lattice.levels.empty()) return plan_.lattice.levels[slot];
    return int(texture_.patches[plan_.faces[slot]].level);
  }

  glm::uvec2 patch(std::size_t slot) const {
    const std::uint64_t first =
        repacked_ ? first_of_slot_[slot] : texture_.patches[plan_.faces[slot]].first_texel;
    return {std::uint32_t(first), std::uint32_t(level(slot))};
  }

  /// Calls visit(i, source) for texels [first, first + count) of the device, `source` being the
  /// soup's texel that belongs there.
  template <class Visit>
  void for_each(std::uint64_t first, std::uint64_t count, const Visit& visit) const {
    if (!repacked_) {
      for (std::uint64_t i = 0; i < count; ++i) visit(i, first + i);
      return;
    }
    std::size_t slot =
        std::size_t(std::upper_bound(first_of_slot_.begin(), first_of_slot_.end(), first) -
                    first_of_slot_.begin() - 1);
    for (std::uint64_t i = 0; i < count; ++slot) {
      const LatticePatch& patch = texture_.patches[plan_.faces[slot]];
      const int n = lattice::resolution(int(patch.level));
      const bool corners_only = level(slot) < int(patch.level);
      const std::uint32_t corners[3] = {lattice::texel_index(0, 0), lattice::texel_index(n, 0),
                                        lattice::texel_index(0, n)};
      std::uint64_t k = first + i - first_of_slot_[slot];
      const std::uint64_t texels = lattice::texel_count(level(slot));
      for (; k < texels && i < count; ++k, ++i)
        visit(i, patch.first_texel + (corners_only ? corners[k] : k));
    }
  }

 private:
  const LatticeTexture& texture_;
  const RenderPlan& plan_;
  bool repacked_ = false;
  std::uint64_t texel_count_ = 0;
  std::vector<std::uint64_t> first_of_slot_;
};

/// A store of `width` values a texel, the soup's channels from `channel` on; those past the last
/// feature are 0 unless asked for alone.
template <class Value>
TexelStore channel_store(const std::vector<Value>& values, const Placement& placement,
                         const TexelLayout& layout, const TexelFormat& format, int channel,
                         int width) {
  const int copied =
      std::min(width, channel == LatticeTexture::features ? 1 : LatticeTexture::features - channel);
  return TexelStore(
      layout, format, placement.texel_count(), "lattice texels",
      [&](std::uint64_t first, std::span<std::byte> out) {
        std::fill(out.begin(), out.end(), std::byte{0});
        placement.for_each(
            first, out.size() / format.bytes, [&](std::uint64_t i, std::uint64_t source) {
              std::memcpy(&out[i * format.bytes],
                          &values[source * LatticeTexture::channels + std::uint64_t(channel)],
                          sizeof(Value) * std::size_t(copied));
            });
      });
}

}  // namespace

LatticeStores upload_lattice(const LatticeTexture& texture, const RenderPlan& plan,
                             const TexelLayout& layout) {
  const Placement placement(texture, plan);
  const bool is_float = texture.is_float();
  const TexelFormat wide = is_float ? texel_formats::rgba32f : texel_formats::rgba8;
  const TexelFormat narrow = is_float ? texel_formats::r32f : texel_formats::r8;
  if (placement.texel_count() > layout.capacity()) {
    const std::uint64_t per_face =
        placement.texel_count() / std::max<std::size_t>(plan.faces.size(), 1);
    throw DeviceLimitError(
        std::to_string(plan.faces.size()) + " triangles have " +
        std::to_string(placement.texel_count()) + " lattice texels; this device holds " +
        std::to_string(layout.capacity()) + " a texture: about " +
        std::to_string(layout.capacity() / std::max<std::uint64_t>(per_face, 1)) +
        " such triangles would fit, or four times as many a level lower");
  }
  LatticeStores stores;
  std::visit(
      [&](const auto& values) {
        stores.features0 = channel_store(values, placement, layout, wide, 0, 4);
        if (plan.color_mlp) stores.features1 = channel_store(values, placement, layout, wide, 4, 4);
        if (plan.opaque_count < plan.faces.size())
          stores.alphas =
              channel_store(values, placement, layout, narrow, LatticeTexture::features, 1);
      },
      texture.texels);
  if (plan.lattice.uniform_level < 0) {
    std::vector<glm::uvec2> patches(plan.faces.size());
    for (std::size_t slot = 0; slot < patches.size(); ++slot) patches[slot] = placement.patch(slot);
    stores.patches = TexelStore::from(layout, texel_formats::rg32ui,
                                      std::span<const glm::uvec2>(patches), "lattice patches");
  }
  return stores;
}

}  // namespace tureen
