#include "oracle/splats.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

#include "oracle/splat_kernels.hpp"

namespace tureen::oracle {

namespace {

/// Rows of samples whose splats are kept together for SplatOrder::exact.
constexpr int sorted_rows = 16;

/// A splat of the scene.
struct SplatKey {
  double depth;  // of the centre
  std::uint32_t layer;
  std::uint32_t index;

  bool operator<(const SplatKey& other) const {
    return std::tie(depth, layer, index) < std::tie(other.depth, other.layer, other.index);
  }
};

/// Samples [first, end) along each axis.
struct SampleRange {
  int first_column, end_column, first_row, end_row;
};

int clamped_to(double value, int low, int high) {
  // Clamped before the conversion: boxes may be larger than an int. NaN becomes low.
  return static_cast<int>(std::min(std::max(double(low), value), double(high)));
}

class Blender {
 public:
  Blender(std::span<const PlacedLayer> layers, const Camera& camera,
          std::span<const double> opaque_depth, const SplatBlending& options)
      : layers_(layers),
        opaque_depth_(opaque_depth),
        options_(options),
        columns_(camera.width * options.supersampling),
        rows_(camera.height * options.supersampling),
        samples_(std::size_t(columns_) * rows_) {
    assert(opaque_depth.size() == samples_.size());
    for (const PlacedLayer& layer : layers)
      views_.emplace_back(layer.place.world_from_layer, camera, options.near, options.culls,
                          options.whole);
    sort_centers();
  }

  std::vector<BlendedSample> blended() && {
    if (options_.order == SplatOrder::center)
      blend_by_center();
    else
      blend_exactly();
    return std::move(samples_);
  }

 private:
  const Splats& splats_of(const SplatKey& key) const { return *layers_[key.layer].splats; }

  void sort_centers() {
    for (std::uint32_t layer = 0; layer < layers_.size(); ++layer) {
      const Splats& splats = *layers_[layer].splats;
      const double nearest = double(splats.profile.min_center_depth) * views_[layer].scale();
      for (std::uint32_t i = 0; i < count(splats); ++i) {
        const double depth = views_[layer].point(center(splats, i)).z;
        if (std::isfinite(depth) && (nearest == 0 || depth > nearest))
          keys_.push_back({depth, layer, i});
      }
    }
    std::sort(keys_.begin(), keys_.end());
  }

  SampleRange range_of(const ImageBox& box) const {
    // One sample more than the box on each side, for the rounding of its borders.
    const double n = options_.supersampling;
    return {clamped_to(std::floor(box.low.x * n) - 1, 0, columns_),
            clamped_to(std::ceil(box.high.x * n) + 1, 0, columns_),
            clamped_to(std::floor(box.low.y * n) - 1, 0, rows_),
            clamped_to(std::ceil(box.high.y * n) + 1, 0, rows_)};
  }

  std::size_t index(int column, int row) const { return std::size_t(row) * columns_ + column; }

  /// The sample's image point, in pixels.
  glm::dvec2 pixel(int column, int row) const {
    return glm::dvec2(column + 0.5, row + 0.5) / double(options_.supersampling);
  }

  void add(BlendedSample& to, const SplatSample& splat, const glm::dvec3& color,
           const SplatProfile& profile) const {
    const double next = to.transmittance * (1 - splat.alpha);
    if (options_.stop && next < double(profile.stop_transmittance)) {
      to.ended = true;
      return;
    }
    to.color += to.transmittance * splat.alpha * color;
    if (to.transmittance > 0.5 && next <= 0.5) to.median_depth = splat.depth;
    to.transmittance = next;
    // Further splats would add 0.
    to.ended = next == 0;
  }

  /// visit(sample, splat, colour) for each sample in rows [first_row, end_row) that the splat
  /// covers, except where blending has ended.
  template <class Visit>
  void for_each_sample(const SplatKey& key, int first_row, int end_row, const Visit& visit) const {
    const auto splat = project(splats_of(key), key.index, views_[key.layer]);
    if (!splat) return;
    const SplatColorInView color(splats_of(key), key.index, views_[key.layer].eye());
    const SampleRange range = range_of(box_of(*splat));
    for (int row = std::max(first_row, range.first_row); row < std::min(end_row, range.end_row);
         ++row)
      for (int column = range.first_column; column < range.end_column; ++column) {
        const std::size_t i = index(column, row);
        if (samples_[i].ended) continue;
        const glm::dvec2 point = pixel(column, row);
        const SplatSample there = sample(*splat, point, opaque_depth_[i]);
        if (there.alpha > 0) visit(i, there, color.at(*splat, point));
      }
  }

  void blend_by_center() {
    for (std::size_t k = 0; k < keys_.size(); ++k) {
      report(k, keys_.size());
      const SplatProfile& profile = splats_of(keys_[k]).profile;
      for_each_sample(keys_[k], 0, rows_,
                      [&](std::size_t i, const SplatSample& splat, const glm::dvec3& color) {
                        add(samples_[i], splat, color, profile);
                      });
    }
  }

  /// A splat at a sample, for sorting.
  struct Candidate {
    std::size_t sample;
    SplatSample splat;
    std::uint32_t layer, index;
    glm::dvec3 color;

    bool operator<(const Candidate& other) const {
      return std::tie(sample, splat.order, layer, index) <
             std::tie(other.sample, other.splat.order, other.layer, other.index);
    }
  };

  void blend_exactly() {
    std::vector<std::pair<int, int>> rows;  // [first, end) of each key
    for (const SplatKey& key : keys_) {
      const auto splat = project(splats_of(key), key.index, views_[key.layer]);
      const SampleRange range = splat ? range_of(box_of(*splat)) : SampleRange{};
      rows.emplace_back(range.first_row, range.end_row);
    }
    std::vector<Candidate> candidates;
    for (int first = 0; first < rows_; first += sorted_rows) {
      report(first, rows_);
      const int end = std::min(first + sorted_rows, rows_);
      candidates.clear();
      for (std::size_t k = 0; k < keys_.size(); ++k)
        if (rows[k].first < end && rows[k].second > first)
          for_each_sample(keys_[k], first, end,
                          [&, &key = keys_[k]](std::size_t i, const SplatSample& splat,
                                               const glm::dvec3& color) {
                            candidates.push_back({i, splat, key.layer, key.index, color});
                          });
      std::sort(candidates.begin(), candidates.end());
      for (const Candidate& each : candidates) {
        BlendedSample& to = samples_[each.sample];
        if (to.ended) continue;
        add(to, each.splat, each.color, layers_[each.layer].splats->profile);
      }
    }
  }

  /// At most 256 calls a frame.
  void report(std::size_t done, std::size_t all) const {
    if (options_.progress && done % (all / 256 + 1) == 0) options_.progress(double(done) / all);
  }

  std::span<const PlacedLayer> layers_;
  std::span<const double> opaque_depth_;
  const SplatBlending& options_;
  int columns_, rows_;
  std::vector<SplatView> views_;
  std::vector<SplatKey> keys_;  // from front to back
  std::vector<BlendedSample> samples_;
};

}  // namespace

std::vector<BlendedSample> blend(std::span<const PlacedLayer> layers, const Camera& camera,
                                 std::span<const double> opaque_depth,
                                 const SplatBlending& options) {
  return Blender(layers, camera, opaque_depth, options).blended();
}

}  // namespace tureen::oracle
