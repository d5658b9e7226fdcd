#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <new>
#include <utility>

#include "base/output.hpp"
#include "base/threads/thread_pool.hpp"
#include "formats/common/splat_activation.hpp"
#include "formats/splat/splat_writing.hpp"
#include "formats/splat/spz.hpp"
#include "formats/splat/spz_layout.hpp"
#include "image/quantise.hpp"
#include "scene/edit/morton_order.hpp"

namespace tureen {

namespace {

using SpzArrays = std::array<std::vector<std::byte>, spz_array::count>;

constexpr int usual_fractional_bits = 12, least_bits_across = 16;
/// Levels of the compressors: their defaults, since the arrays are close to noise.
constexpr int zstd_level = 6, zlib_level = 6;

void append_bytes(std::vector<std::byte>& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(std::byte(value >> (8 * i) & 255));
}

/// The bits behind the point with which all centres fit into 24 bits.
int fractional_bits_of(const Gaussians& gaussians) {
  double farthest = 0, across = 0;
  glm::dvec3 low(0), high(0);
  for (std::size_t i = 0; i < gaussians.centers.size(); ++i) {
    const glm::dvec3 center(gaussians.centers[i]);
    low = i == 0 ? center : glm::min(low, center);
    high = i == 0 ? center : glm::max(high, center);
  }
  for (int k = 0; k < 3; ++k) {
    farthest = std::max({farthest, std::abs(low[k]), std::abs(high[k])});
    across = std::max(across, high[k] - low[k]);
  }
  int bits = usual_fractional_bits;
  while (bits < 22 && across > 0 && across < std::ldexp(1.0, least_bits_across - bits)) ++bits;
  // The farthest centre rounds to at most 2^23 - 1.
  while (bits > 0 && farthest > std::ldexp(1.0, 23 - bits) - std::ldexp(2.0, -bits)) --bits;
  return bits;
}

struct SpzQuantiser {
  const StoredGaussians& stored;
  int fractional_bits;
  std::uint64_t clipped_centers = 0, clipped_scales = 0, clipped_colors = 0;

  /// The byte of a value; counts those outside the range.
  static std::uint8_t byte_of(double value, std::uint64_t& clipped) {
    const double rounded = std::round(value);
    if (rounded < 0 || rounded > 255) ++clipped;
    return std::uint8_t(std::clamp(rounded, 0.0, 255.0));
  }

  SpzArrays arrays() {
    SpzArrays result;
    const auto& gaussians = stored.gaussians();
    const auto signs = signs_after_turn();
    const std::size_t each = coefficients_per_splat(stored.splats.color);
    for (std::size_t i = 0; i < gaussians.centers.size(); ++i) {
      glm::vec3 scales = gaussians.scales[i];
      glm::quat rotation = gaussians.rotations[i];
      order_axes(scales, rotation, false);
      for (int k = 0; k < 3; ++k) {
        const double turned = double(gaussians.centers[i][k]) * (k == 0 ? 1 : -1);
        const double fixed = std::round(std::ldexp(turned, fractional_bits));
        if (std::abs(fixed) > 8388607) ++clipped_centers;
        append_bytes(result[spz_array::positions],
                     std::uint64_t(std::int64_t(std::clamp(fixed, -8388608.0, 8388607.0))), 3);
      }
      append_bytes(result[spz_array::alphas], quantised_unit(gaussians.opacity[i]), 1);
      for (int k = 0; k < 3; ++k) {
        const double log = double(stored_scale(double(scales[k])));
        // A disc has no thickness: the smallest scale is no loss.
        std::uint64_t ignored = 0;
        append_bytes(result[spz_array::scales],
                     byte_of((log + 10) * 16, scales[k] > 0 ? clipped_scales : ignored), 1);
      }
      append_bytes(result[spz_array::rotations], packed_rotation(rotation), 4);
      const glm::vec3* coefficients = &stored.splats.color.coefficients[i * each];
      for (int c = 0; c < 3; ++c)
        append_bytes(result[spz_array::colors],
                     byte_of((double(coefficients[0][c]) * 0.15 + 0.5) * 255, clipped_colors), 1);
      for (std::size_t k = 1; k < each; ++k)
        for (int c = 0; c < 3; ++c)
          append_bytes(result[spz_array::rest],
                       packed_coefficient(double(signs[k] * coefficients[k][c]), k < 4 ? 5 : 4), 1);
    }
    return result;
  }

  /// To the nearest of 2^bits values, so that compressors see few.
  std::uint8_t packed_coefficient(double value, int bits) {
    const double step = std::ldexp(1.0, 8 - bits);
    if (std::abs(value) > 1) ++clipped_colors;
    return std::uint8_t(std::clamp(std::round(value * 128 / step) * step + 128, 0.0, 255.0));
  }

  /// `rotation` has its largest part in w, which is positive.
  static std::uint32_t packed_rotation(const glm::quat& rotation) {
    std::uint32_t word = 3;
    for (const double part : {double(rotation.x), -double(rotation.y), -double(rotation.z)}) {
      const auto size =
          std::uint32_t(std::clamp(std::round(std::abs(part) * std::sqrt(2.0) * 511), 0.0, 511.0));
      word = word << 10 | (part < 0 ? 512u : 0u) | size;
    }
    return word;
  }

  void add_losses(std::vector<std::string>& lost) const {
    const auto add = [&](std::uint64_t count, const char* what) {
      if (count > 0) lost.push_back(std::to_string(count) + " " + what);
    };
    add(clipped_centers, "coordinates are outside the range of SPZ: clipped.");
    add(clipped_scales, "scales are outside the range of SPZ, e^-10 to e^5.9: clipped.");
    add(clipped_colors, "colour coefficients are outside the range of SPZ: clipped.");
  }
};

std::vector<std::byte> gzipped_spz(std::span<const std::byte> content) {
  z_stream stream{};
  if (deflateInit2(&stream, zlib_level, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::bad_alloc();
  std::vector<std::byte> packed;
  std::array<std::byte, 65536> block;
  int status = Z_OK;
  while (status == Z_OK) {
    // zlib counts input in 32 bits.
    if (stream.avail_in == 0 && !content.empty()) {
      const auto part = content.first(std::min<std::size_t>(content.size(), 1u << 30));
      stream.next_in =
          const_cast<Bytef*>(reinterpret_cast<const Bytef*>(part.data()));  // only read
      stream.avail_in = uInt(part.size());
      content = content.subspan(part.size());
    }
    stream.next_out = reinterpret_cast<Bytef*>(block.data());
    stream.avail_out = uInt(block.size());
    status = deflate(&stream, content.empty() ? Z_FINISH : Z_NO_FLUSH);
    packed.insert(packed.end(), block.begin(), block.end() - stream.avail_out);
  }
  deflateEnd(&stream);
  return packed;
}

std::vector<std::byte> zstd_stream(std::span<const std::byte> content) {
  std::vector<std::byte> packed(ZSTD_compressBound(content.size()));
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), zstd_level);
  if (ZSTD_isError(size)) throw std::bad_alloc();  // the only fault with room for the bound
  packed.resize(size);
  return packed;
}

}  // namespace

std::vector<std::string> write_spz(const Scene& scene, const std::filesystem::path& path,
                                   int version) {
  // The degree of the newest version; older readers stop at 3.
  StoredGaussians stored =
      gaussians_for(scene, {.name = "SPZ", .max_degree = version == 3 ? 3 : 4});
  sort_in_morton_order(stored.splats);
  SpzQuantiser quantiser{.stored = stored,
                         .fractional_bits = fractional_bits_of(stored.gaussians())};
  const SpzArrays arrays = quantiser.arrays();
  std::vector<std::byte> head;
  append_bytes(head, spz_magic, 4);
  append_bytes(head, std::uint64_t(version), 4);
  append_bytes(head, count(stored.splats), 4);
  append_bytes(head, std::uint64_t(stored.splats.color.degree), 1);
  append_bytes(head, std::uint64_t(quantiser.fractional_bits), 1);
  append_bytes(head, stored.profile == "mip" ? flag_antialiased : 0, 1);
  Output output(path);
  if (version == 3) {
    append_bytes(head, 0, 1);
    for (const auto& array : arrays) head.insert(head.end(), array.begin(), array.end());
    output.write(gzipped_spz(head));
  } else {
    std::vector<const std::vector<std::byte>*> used;
    for (const auto& array : arrays)
      if (!array.empty()) used.push_back(&array);
    std::vector<std::vector<std::byte>> streams(used.size());
    ThreadPool().run(used.size(), [&](std::size_t i) { streams[i] = zstd_stream(*used[i]); });
    append_bytes(head, used.size(), 1);
    append_bytes(head, plain_header_size, 4);
    head.resize(plain_header_size);
    for (std::size_t i = 0; i < used.size(); ++i) {
      append_bytes(head, streams[i].size(), 8);
      append_bytes(head, used[i]->size(), 8);
    }
    output.write(head);
    for (const auto& stream : streams) output.write(stream);
  }
  output.commit();
  std::vector<std::string> lost = std::move(stored.lost);
  quantiser.add_losses(lost);
  return lost;
}

}  // namespace tureen
