#include "runtime/passes/lattice_source.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <utility>

#include "base/error.hpp"
#include "scene/lattice.hpp"

namespace tureen {

namespace {

/// A run of texels or cells on the device, and its source.
struct Run {
  std::uint64_t first;  // on the device
  std::uint32_t face;   // of the soup
  int level;            // on the device, at most the soup's
};

/// Source and destination of the texels and cells of each slot.
class Placement {
 public:
  Placement(const LatticeTexture& texture, const SoupPlan& plan) : texture_(texture) {
    // Without a uniform level and without changed levels, texels are uploaded unchanged, and faces
    // that share texels share cells.
    repacked_ = plan.lattice.uniform_level >= 0 || !plan.lattice.levels.empty();
    patches_.resize(plan.faces.size());
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint64_t> known_cells;
    for (std::size_t slot = 0; slot < plan.faces.size(); ++slot) {
      const std::uint32_t face = plan.faces[slot];
      const LatticePatch& patch = texture.patches[face];
      const int level =
          plan.lattice.levels.empty() ? int(patch.level) : int(plan.lattice.levels[slot]);
      std::uint64_t first_texel = patch.first_texel, first_cell = cell_count_;
      bool new_cells = true;
      if (repacked_) {
        first_texel = texel_count_;
        texel_runs_.push_back({texel_count_, face, level});
        texel_count_ += lattice::texel_count(level);
      } else {
        const auto [known, inserted] =
            known_cells.try_emplace({patch.first_texel, patch.level}, cell_count_);
        first_cell = known->second;
        new_cells = inserted;
      }
      if (new_cells) {
        cell_runs_.push_back({cell_count_, face, level});
        cell_count_ += lattice::cell_count(level);
      }
      patches_[slot] = glm::uvec4(std::uint32_t(first_texel), level, std::uint32_t(first_cell), 0);
    }
    if (!repacked_) texel_count_ = texture.texel_count();
  }

  std::uint64_t texel_count() const { return texel_count_; }
  std::uint64_t cells() const { return cell_count_; }
  std::span<const glm::uvec4> patches() const { return patches_; }

  /// Calls visit(i, source, n) for pieces of the texels [first, first + count) on the device:
  /// texels i .. i + n are the soup's texels source .. source + n.
  template <class Visit>
  void for_each_piece(std::uint64_t first, std::uint64_t count, const Visit& visit) const {
    if (!repacked_) return visit(0, first, count);
    for_each_run(
        texel_runs_, first, count, [](const Run& run) { return lattice::texel_count(run.level); },
        [&](const Run& run, std::uint64_t i, std::uint32_t k, std::uint32_t n) {
          const Source source(texture_.patches[run.face], run.level);
          if (source.is_whole()) return visit(i, source.texel(k), n);
          for (std::uint32_t end = k + n; k < end; ++k, ++i) visit(i, source.texel(k), 1);
        });
  }

  /// Calls visit(i, sources) for cells [first, first + count): `sources` are the soup's texels at
  /// the corners (x+1, y), (x, y+1), (x, y) and (x+1, y+1), the last one moved to the border for
  /// cells on the last diagonal.
  template <class Visit>
  void for_each_cell(std::uint64_t first, std::uint64_t count, const Visit& visit) const {
    for_each_run(
        cell_runs_, first, count, [](const Run& run) { return lattice::cell_count(run.level); },
        [&](const Run& run, std::uint64_t i, std::uint32_t k, std::uint32_t cells) {
          const Source source(texture_.patches[run.face], run.level);
          const int n = lattice::resolution(run.level);
          for (std::uint32_t end = k + cells; k < end; ++k, ++i) {
            const auto [x, y] = lattice::texel_coordinates(k);
            const int corner_y = std::min(y + 1, n - (x + 1));
            visit(i, std::array{source.texel(lattice::texel_index(x + 1, y)),
                                source.texel(lattice::texel_index(x, y + 1)),
                                source.texel(lattice::texel_index(x, y)),
                                source.texel(lattice::texel_index(x + 1, corner_y))});
          }
        });
  }

 private:
  /// Maps texel k of a face on the device to a texel of the soup. A face below its soup's level
  /// keeps only its three corner texels.
  class Source {
   public:
    Source(const LatticePatch& patch, int level)
        : first_(patch.first_texel), corners_only_(level < int(patch.level)) {
      const int n = lattice::resolution(int(patch.level));
      corners_ = {lattice::texel_index(0, 0), lattice::texel_index(n, 0),
                  lattice::texel_index(0, n)};
    }
    bool is_whole() const { return !corners_only_; }
    std::uint64_t texel(std::uint32_t k) const {
      return first_ + (corners_only_ ? corners_[k] : k);
    }

   private:
    std::uint64_t first_;
    bool corners_only_;
    std::array<std::uint32_t, 3> corners_;
  };

  /// Calls visit(run, i, k, n) for the parts of runs in [first, first + count): elements k .. k + n
  /// of the run are elements i .. i + n of this range.
  template <class Length, class Visit>
  static void for_each_run(const std::vector<Run>& runs, std::uint64_t first, std::uint64_t count,
                           const Length& length, const Visit& visit) {
    auto run = std::upper_bound(runs.begin(), runs.end(), first,
                                [](std::uint64_t f, const Run& r) { return f < r.first; });
    if (run != runs.begin()) --run;
    for (std::uint64_t i = 0; i < count; ++run) {
      const auto k = std::uint32_t(first + i - run->first);
      if (k >= length(*run)) continue;
      const auto n = std::uint32_t(std::min<std::uint64_t>(length(*run) - k, count - i));
      visit(*run, i, k, n);
      i += n;
    }
  }

  const LatticeTexture& texture_;
  bool repacked_ = false;
  std::uint64_t texel_count_ = 0, cell_count_ = 0;
  std::vector<Run> texel_runs_, cell_runs_;
  std::vector<glm::uvec4> patches_;
};

using SharedPlacement = std::shared_ptr<const Placement>;

/// Copies `n` channels of each texel of a piece, without gaps.
template <std::size_t n, class Value>
void copy_channels(const Value* from, std::uint64_t texels, std::byte* to) {
  constexpr std::size_t bytes = n * sizeof(Value);
  for (; texels > 0; --texels, from += LatticeTexture::channels, to += bytes)
    std::memcpy(to, from, bytes);
}

/// Features 0 to 3, or 4 to 6 and a zero.
template <class Value>
TexelSource feature_source(const std::vector<Value>& values, const SharedPlacement& placement,
                           const TexelFormat& format, int channel) {
  const auto fill = [&values, placement, channel](std::uint64_t first, std::span<std::byte> out) {
    constexpr std::size_t each = 4 * sizeof(Value);
    placement->for_each_piece(
        first, out.size() / each, [&](std::uint64_t i, std::uint64_t source, std::uint64_t n) {
          copy_channels<4>(&values[source * LatticeTexture::channels + std::uint64_t(channel)], n,
                           &out[i * each]);
        });
    constexpr std::array<std::byte, sizeof(Value)> zero{};
    if (channel + 4 > LatticeTexture::features)
      for (std::size_t end = each; end <= out.size(); end += each)
        std::memcpy(&out[end - zero.size()], zero.data(), zero.size());
  };
  return {format, placement->texel_count(), "lattice texels", fill};
}

template <class Value>
TexelSource alpha_cell_source(const std::vector<Value>& values, const SharedPlacement& placement,
                              const TexelFormat& format) {
  const auto fill = [&values, placement, each = format.bytes](std::uint64_t first,
                                                              std::span<std::byte> out) {
    placement->for_each_cell(
        first, out.size() / each,
        [&](std::uint64_t i, const std::array<std::uint64_t, 4>& sources) {
          Value corners[4];
          for (std::size_t k = 0; k < 4; ++k)
            corners[k] = values[sources[k] * LatticeTexture::channels + LatticeTexture::features];
          std::memcpy(&out[i * each], corners, sizeof corners);
        });
  };
  return {format, placement->cells(), "lattice alpha", fill};
}

template <class Value>
TexelSource alpha_texel_source(const std::vector<Value>& values, const SharedPlacement& placement) {
  const auto fill = [&values, placement](std::uint64_t first, std::span<std::byte> out) {
    placement->for_each_piece(
        first, out.size() / sizeof(Value),
        [&](std::uint64_t i, std::uint64_t source, std::uint64_t n) {
          copy_channels<1>(&values[source * LatticeTexture::channels + LatticeTexture::features], n,
                           &out[i * sizeof(Value)]);
        });
  };
  return {sizeof(Value) == 1 ? texel_formats::r8 : texel_formats::r32f, placement->texel_count(),
          "lattice alpha", fill};
}

void check_capacity(const Placement& placement, const SoupPlan& plan, const TexelLayout& layout) {
  const std::uint64_t needed = std::max(placement.texel_count(), placement.cells());
  if (needed <= layout.capacity()) return;
  const std::uint64_t fitting = layout.capacity() * plan.faces.size() / needed;
  throw DeviceLimitError(
      std::to_string(plan.faces.size()) + " triangles have " +
      std::to_string(placement.texel_count()) + " lattice texels, but this device holds " +
      std::to_string(layout.capacity()) + " a texture: about " + std::to_string(fitting) +
      " such triangles fit, or four times as many at a lower lattice level");
}

}  // namespace

LatticeSources prepare_lattice(const LatticeTexture& texture, const SoupPlan& plan,
                               const TexelLayout& layout) {
  const auto placement = std::make_shared<const Placement>(texture, plan);
  check_capacity(*placement, plan, layout);
  const TexelFormat format = texture.is_float() ? texel_formats::rgba32f : texel_formats::rgba8;
  const bool cut_outs = plan.opaque_count < plan.faces.size();
  LatticeSources sources;
  std::visit(
      [&](const auto& values) {
        sources.features0 = feature_source(values, placement, format, 0);
        if (plan.latent_features) sources.features1 = feature_source(values, placement, format, 4);
        if (cut_outs)
          sources.alpha = plan.lattice.alpha_by_cell ? alpha_cell_source(values, placement, format)
                                                     : alpha_texel_source(values, placement);
      },
      texture.texels);
  if (plan.lattice.uniform_level < 0) {
    const auto patches = placement->patches();
    sources.patches =
        TexelSource::of(texel_formats::rgba32ui,
                        std::vector<glm::uvec4>(patches.begin(), patches.end()), "lattice patches");
  }
  return sources;
}

}  // namespace tureen
