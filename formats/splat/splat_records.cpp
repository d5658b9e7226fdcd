#include "formats/splat/splat_records.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <system_error>

#include "base/extension.hpp"
#include "base/little_endian.hpp"
#include "base/output.hpp"
#include "formats/common/progress_meter.hpp"
#include "formats/splat/splat_builder.hpp"
#include "formats/splat/splat_writing.hpp"
#include "image/quantise.hpp"
#include "scene/edit/splat_limit.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

/// 0 is b = 127.5, which no byte has: writers round it up to 128.
double rotation_part(std::byte byte) { return std::to_integer<int>(byte) / 127.5 - 1.0; }

double byte_fraction(std::byte byte) { return std::to_integer<int>(byte) / 255.0; }

}  // namespace

namespace {

/// Whether the bytes are those of a splat in use: a finite centre, scales above 0, a rotation of
/// unit length up to the rounding of its bytes.
bool is_plausible(std::span<const std::byte> record) {
  double length = 0;
  for (std::size_t i = 0; i < 4; ++i) length += std::pow(rotation_part(record[28 + i]), 2);
  for (std::size_t i = 0; i < 3; ++i) {
    const float center = little_float(record, 4 * i), scale = little_float(record, 12 + 4 * i);
    if (!std::isfinite(center) || !(scale > 0 && std::isfinite(scale))) return false;
  }
  return std::abs(std::sqrt(length) - 1) < 0.05;
}

}  // namespace

bool is_splat_records(const std::filesystem::path& path, std::span<const std::byte> head) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(path, failed);
  if (failed || size == 0 || size % splat_record_size != 0) return false;
  if (extension_of(path) == ".splat") return true;
  const std::size_t records = head.size() / splat_record_size;
  for (std::size_t i = 0; i < records; ++i)
    if (!is_plausible(head.subspan(i * splat_record_size, splat_record_size))) return false;
  return records > 0;
}

Scene read_splat_records(Input& input, const ReadOptions& options) {
  if (input.size() % splat_record_size != 0)
    input.fail_at(input.size() / splat_record_size * splat_record_size,
                  "a .splat file has records of 32 bytes, but its last one has " +
                      std::to_string(input.size() % splat_record_size));
  SplatBuilder builder(input, options, Gaussians{}, 0, input.size() / splat_record_size);
  ProgressMeter meter(options);
  std::array<std::byte, 256 * splat_record_size> block;
  input.seek(0);
  while (input.remaining() > 0) {
    const std::size_t size = input.read_some(block);
    if (size % splat_record_size != 0) input.fail("the file ends within a record");
    for (std::size_t at = 0; at < size; at += splat_record_size) {
      meter.step([&] { return double(input.position()) / double(input.size()); });
      const auto record = std::span(block).subspan(at, splat_record_size);
      SplatValues splat;
      for (int k = 0; k < 3; ++k) {
        splat.center[k] = little_float(record, std::size_t(4 * k));
        splat.scales[k] = little_float(record, std::size_t(12 + 4 * k));
      }
      glm::vec3 color;
      for (int k = 0; k < 3; ++k)
        color[k] = float((byte_fraction(record[std::size_t(24 + k)]) - 0.5) / harmonics::y00);
      splat.opacity = byte_fraction(record[27]);
      splat.rotation = {rotation_part(record[28]), rotation_part(record[29]),
                        rotation_part(record[30]), rotation_part(record[31])};
      builder.add(splat, std::span(&color, 1));
    }
  }
  return builder.finish(*profile_named("3dgs"), ".splat");
}

Scene read_splat_records(const std::filesystem::path& path, const ReadOptions& options) {
  Input input = Input::open(path);
  return read_splat_records(input, options);
}

std::vector<std::string> write_splat_records(const Scene& scene,
                                             const std::filesystem::path& path) {
  StoredGaussians stored =
      gaussians_for(scene, {.name = ".splat", .max_degree = 0, .has_mip = false});
  const Gaussians& gaussians = stored.gaussians();
  const std::vector<double> contributions = splat_contributions(stored.splats.kernel);
  std::vector<std::uint32_t> order(contributions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return contributions[a] > contributions[b];
  });
  std::uint64_t clipped = 0;
  Output output(path);
  for (const std::uint32_t i : order) {
    output.write_value(gaussians.centers[i]);
    output.write_value(gaussians.scales[i]);
    const glm::vec3 color = 0.5f + float(harmonics::y00) * stored.splats.color.coefficients[i];
    const glm::quat& q = gaussians.rotations[i];
    std::array<std::uint8_t, 8> bytes;
    for (std::size_t c = 0; c < 3; ++c) {
      bytes[c] = quantised_unit(color[int(c)]);
      if (color[int(c)] < 0 || color[int(c)] > 1) ++clipped;
    }
    bytes[3] = quantised_unit(gaussians.opacity[i]);
    std::size_t at = 4;
    for (const float part : {q.w, q.x, q.y, q.z})
      bytes[at++] = std::uint8_t(std::clamp(std::lround((double(part) + 1) * 127.5), 0l, 255l));
    output.write_value(bytes);
  }
  output.commit();
  if (clipped > 0)
    stored.lost.push_back(std::to_string(clipped) + " colours are outside 0 to 1: clipped.");
  return stored.lost;
}

}  // namespace tureen
