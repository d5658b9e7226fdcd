#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/output.hpp"
#include "formats/common/splat_activation.hpp"
#include "formats/splat/compressed_ply.hpp"
#include "formats/splat/splat_ply_layout.hpp"
#include "formats/splat/splat_writing.hpp"
#include "scene/edit/morton_order.hpp"

namespace tureen {

namespace {

constexpr std::size_t chunk_splats = 256;
/// Logarithms of scales beyond it are clamped, as PlayCanvas does: one splat of size 0 would take
/// all steps of its chunk.
constexpr double farthest_log = 20;

/// Minimum and maximum of three values over a chunk.
struct ChunkRange {
  glm::vec3 low{0}, high{0};

  ChunkRange(std::size_t count, auto&& value) {
    low = high = value(std::size_t(0));
    for (std::size_t i = 1; i < count; ++i) {
      low = glm::min(low, value(i));
      high = glm::max(high, value(i));
    }
  }
  /// The value as a fraction of the range in `bits` bits.
  std::uint32_t fraction(const glm::vec3& value, int axis, int bits) const {
    const double range = double(high[axis]) - double(low[axis]);
    const double part = range > 0 ? (double(value[axis]) - double(low[axis])) / range : 0;
    return std::uint32_t(std::lround(part * double((1u << bits) - 1)));
  }
  /// 11 bits of x, 10 of y, 11 of z.
  std::uint32_t packed(const glm::vec3& value) const {
    return fraction(value, 0, 11) << 21 | fraction(value, 1, 10) << 11 | fraction(value, 2, 11);
  }
};

class CompressedPlyWriter {
 public:
  explicit CompressedPlyWriter(const StoredGaussians& stored) : stored_(stored) {
    for (std::size_t i = 0; i < gaussians().centers.size(); ++i) {
      scales_.push_back(gaussians().scales[i]);
      rotations_.push_back(gaussians().rotations[i]);
      order_axes(scales_[i], rotations_[i], gaussians().flat);
      for (int k = 0; k < 3; ++k)
        scales_[i][k] = float(
            std::clamp(double(stored_scale(double(scales_[i][k]))), -farthest_log, farthest_log));
      colors_.push_back(glm::vec3(
          0.5 + harmonics::y00 * glm::dvec3(stored.splats.color.coefficients[i * each_])));
    }
  }

  void write(Output& output) {
    const std::size_t count = gaussians().centers.size();
    const std::size_t chunks = (count + chunk_splats - 1) / chunk_splats;
    output.write(std::string_view(header(count, chunks)));
    const auto of_chunk = [&](std::size_t chunk, const std::vector<glm::vec3>& values) {
      const std::size_t first = chunk * chunk_splats;
      return ChunkRange(std::min(chunk_splats, count - first),
                        [&](std::size_t i) { return values[first + i]; });
    };
    std::vector<std::array<std::uint32_t, 4>> packed;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      const ChunkRange centers = of_chunk(chunk, gaussians().centers),
                       scales = of_chunk(chunk, scales_), colors = of_chunk(chunk, colors_);
      for (const ChunkRange* range : {&centers, &scales, &colors}) {
        output.write_value(range->low);
        output.write_value(range->high);
      }
      for (std::size_t i = chunk * chunk_splats; i < std::min(count, (chunk + 1) * chunk_splats);
           ++i)
        packed.push_back({centers.packed(gaussians().centers[i]), packed_turn(rotations_[i]),
                          scales.packed(scales_[i]),
                          colors.fraction(colors_[i], 0, 8) << 24 |
                              colors.fraction(colors_[i], 1, 8) << 16 |
                              colors.fraction(colors_[i], 2, 8) << 8 |
                              std::uint32_t(std::lround(double(gaussians().opacity[i]) * 255))});
    }
    output.write(std::as_bytes(std::span(packed)));
    write_rest(output);
  }

  std::uint64_t clipped() const { return clipped_; }

 private:
  const Gaussians& gaussians() const { return stored_.gaussians(); }

  std::string header(std::size_t count, std::size_t chunks) const {
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    if (stored_.profile != "3dgs")
      text += "comment SplatRenderMode: " + std::string(stored_.profile) + "\n";
    text += "element chunk " + std::to_string(chunks) + "\n";
    for (const std::string prefix : {"", "scale_"})
      for (const char* limit : {"min_", "max_"})
        for (const char* axis : {"x", "y", "z"})
          text += "property float " + (limit + prefix) + axis + "\n";
    for (const char* limit : {"min_", "max_"})
      for (const char* channel : {"r", "g", "b"})
        text += std::string("property float ") + limit + channel + "\n";
    text += "element vertex " + std::to_string(count) + "\n";
    for (const char* name : {"position", "rotation", "scale", "color"})
      text += std::string("property uint packed_") + name + "\n";
    if (each_ > 1) {
      text += "element sh " + std::to_string(count) + "\n";
      for (std::size_t k = 0; k < 3 * (each_ - 1); ++k)
        text += "property uchar f_rest_" + std::to_string(k) + "\n";
    }
    return text + "end_header\n";
  }

  /// w is the largest part: index 0 in the top bits.
  static std::uint32_t packed_turn(const glm::quat& rotation) {
    std::uint32_t word = 0;
    for (const float part : {rotation.x, rotation.y, rotation.z})
      word = word << 10 | std::uint32_t(std::lround((double(part) * std::sqrt(0.5) + 0.5) * 1023));
    return word;
  }

  void write_rest(Output& output) {
    const int degree = stored_.splats.color.degree;
    const std::size_t values = 3 * (each_ - 1);
    std::vector<std::uint8_t> row(values);
    for (std::size_t i = 0; values > 0 && i < gaussians().centers.size(); ++i) {
      const float* rest = &stored_.splats.color.coefficients[i * each_ + 1].x;
      for (std::size_t k = 0; k < values; ++k) {
        const double value = double(rest[place_of_rest(int(k), degree)]);
        const double byte = std::floor((value / 8 + 0.5) * 256);
        if (byte < 0 || byte > 255) ++clipped_;
        row[k] = std::uint8_t(std::clamp(byte, 0.0, 255.0));
      }
      output.write(std::as_bytes(std::span(row)));
    }
  }

  const StoredGaussians& stored_;
  std::size_t each_ = coefficients_per_splat(stored_.splats.color);
  std::vector<glm::vec3> scales_, colors_;  // logarithms; 1/2 + Y_00 f_dc
  std::vector<glm::quat> rotations_;
  std::uint64_t clipped_ = 0;
};

}  // namespace

std::vector<std::string> write_compressed_ply(const Scene& scene,
                                              const std::filesystem::path& path) {
  StoredGaussians stored = gaussians_for(scene, {.name = "compressed PLY", .has_flat = true});
  sort_in_morton_order(stored.splats);
  CompressedPlyWriter writer(stored);
  Output output(path);
  writer.write(output);
  output.commit();
  std::vector<std::string> lost = std::move(stored.lost);
  if (writer.clipped() > 0)
    lost.push_back(std::to_string(writer.clipped()) +
                   " coefficients are outside the range of compressed PLY, -4 to 4: clipped.");
  return lost;
}

}  // namespace tureen
