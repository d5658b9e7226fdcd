#include "formats/splat/compressed_ply.hpp"

#include <algorithm>
#include <array>

#include "formats/common/format_remarks.hpp"
#include "formats/ply/ply_values.hpp"
#include "formats/splat/splat_ply_layout.hpp"

namespace tureen {

namespace {

constexpr std::uint64_t splats_a_chunk = 256;

/// Ranges of a chunk: slots 0..5 of positions, 6..11 of scales, 12..17 of colours; for each the
/// three minima, then the three maxima.
using ChunkRanges = std::array<float, 18>;
/// Position, rotation, scale, colour.
using PackedSplat = std::array<std::uint32_t, 4>;
enum PackedSlot { packed_position, packed_rotation, packed_scale, packed_color };

/// The fraction 0..1 in `bits` bits from bit `low` on.
double packed_fraction(std::uint32_t word, int low, int bits) {
  const std::uint32_t largest = (std::uint32_t(1) << bits) - 1;
  return double(word >> low & largest) / double(largest);
}

glm::dvec3 packed_fractions(std::uint32_t word) {
  return {packed_fraction(word, 21, 11), packed_fraction(word, 11, 10),
          packed_fraction(word, 0, 11)};
}

glm::dquat unpacked_rotation(std::uint32_t word) {
  std::array<double, 4> parts;  // w, x, y, z
  double squares = 0;
  int low = 20;
  for (std::uint32_t i = 0; i < 4; ++i) {
    if (i == word >> 30) continue;
    parts[i] = (packed_fraction(word, low, 10) - 0.5) * std::sqrt(2.0);
    squares += parts[i] * parts[i];
    low -= 10;
  }
  parts[word >> 30] = std::sqrt(std::max(0.0, 1.0 - squares));
  return {parts[0], parts[1], parts[2], parts[3]};
}

/// The writer stores floor(256 f), so the middle of the step is the best guess, except at the ends,
/// which hold all clamped values.
float unpacked_coefficient(std::uint8_t byte) {
  const double fraction = byte == 0 ? 0.0 : byte == 255 ? 1.0 : (byte + 0.5) / 256.0;
  return static_cast<float>((fraction - 0.5) * 8.0);
}

class CompressedPlyReader {
 public:
  CompressedPlyReader(Input& input, const PlyHeader& header, const ReadOptions& options)
      : input_(input), header_(header), options_(options), values_(input, header, options) {}

  Scene read() {
    const PlyElement& vertex = *header_.find("vertex");
    const PlyElement& chunk = *header_.find("chunk");
    const PlyElement* sh = header_.find("sh");
    if (chunk.count != (vertex.count + splats_a_chunk - 1) / splats_a_chunk)
      fail_element(input_, chunk,
                   "occurs " + std::to_string(chunk.count) + " times for " +
                       std::to_string(vertex.count) + " splats; a chunk holds 256");
    if (sh && sh->count != vertex.count)
      fail_element(input_, *sh,
                   "occurs " + std::to_string(sh->count) + " times for " +
                       std::to_string(vertex.count) + " splats");
    const int degree = sh ? degree_of_rest(input_, *sh, count_rest(*sh)) : 0;
    for (const PlyElement& element : header_.elements) {
      if (&element == &chunk)
        read_chunks(element);
      else if (&element == &vertex)
        read_packed(element);
      else if (&element == sh)
        read_rest(element, degree);
      else
        values_.skip_rows(element);
    }
    const SplatPlyProfile profile = splat_ply_profile(header_, Gaussians{});
    Scene scene = unpack(degree, profile);
    add_profile_remarks(profile, scene);
    if (values_.anything_left())
      scene.info.remarks.push_back({&remarks::bytes_ignored, {{"bytes", values_.remaining()}}});
    return scene;
  }

 private:
  /// Calls `use(slot, value)` for each required property of each row, and `end()` after each row.
  template <class Use, class End>
  void read_rows(const PlyElement& element, const PlySlots& required, Use&& use, End&& end) {
    const std::vector<int> slots = find_slots(input_, element, required);
    for (std::uint64_t row = 0; row < element.count; ++row) {
      values_.read_row(element, slots, use);
      end();
    }
  }

  void read_chunks(const PlyElement& element) {
    PlySlots slots;
    int slot = 0;
    for (const std::string quantity : {"", "scale_", ""}) {
      const bool is_color = slot == 12;
      if (is_color && !element.find("min_r")) break;
      for (const char* limit : {"min_", "max_"})
        for (const char* axis : {is_color ? "r" : "x", is_color ? "g" : "y", is_color ? "b" : "z"})
          slots[limit + quantity + axis] = slot++;
    }
    ChunkRanges row{};
    std::fill(row.begin() + 15, row.end(), 1.0f);  // colours are 0..1 without their ranges
    take_rows(ranges_, element);
    read_rows(
        element, slots, [&](std::size_t at, double value) { row[at] = static_cast<float>(value); },
        [&] { ranges_.push_back(row); });
  }

  void read_packed(const PlyElement& element) {
    const PlySlots slots{{"packed_position", packed_position},
                         {"packed_rotation", packed_rotation},
                         {"packed_scale", packed_scale},
                         {"packed_color", packed_color}};
    for (const PlyProperty& property : element.properties)
      if (slots.count(property.name) && property.type != PlyType::uint32)
        fail_element(input_, element, "has '" + property.name + "' of a type other than uint");
    PackedSplat row{};
    take_rows(packed_, element);
    read_rows(
        element, slots,
        [&](std::size_t at, double value) { row[at] = static_cast<std::uint32_t>(value); },
        [&] { packed_.push_back(row); });
  }

  void read_rest(const PlyElement& element, int degree) {
    PlySlots slots;
    const int count = 3 * (harmonics::count(degree) - 1);
    for (int k = 0; k < count; ++k) slots["f_rest_" + std::to_string(k)] = place_of_rest(k, degree);
    for (const PlyProperty& property : element.properties)
      if (slots.count(property.name) && property.type != PlyType::uint8)
        fail_element(input_, element, "has '" + property.name + "' of a type other than uchar");
    input_.take_memory(element.count, std::size_t(count), "the harmonics");
    rest_.reserve(std::size_t(element.count) * std::size_t(count));
    std::vector<std::uint8_t> row(static_cast<std::size_t>(count));
    read_rows(
        element, slots,
        [&](std::size_t at, double value) { row[at] = static_cast<std::uint8_t>(value); },
        [&] { rest_.insert(rest_.end(), row.begin(), row.end()); });
  }

  Scene unpack(int degree, const SplatPlyProfile& profile) {
    SplatBuilder builder(input_, options_, Gaussians{.flat = profile.is_flat}, degree,
                         packed_.size());
    const auto rest = static_cast<std::size_t>(harmonics::count(degree) - 1);
    std::array<glm::vec3, harmonics::count(harmonics::max_degree)> coefficients;
    for (std::size_t i = 0; i < packed_.size(); ++i) {
      const PackedSplat& packed = packed_[i];
      const ChunkRanges& ranges = ranges_[i / splats_a_chunk];
      const auto in_range = [&](std::size_t first, const glm::dvec3& fraction) {
        glm::dvec3 value;
        for (std::size_t k = 0; k < 3; ++k) {
          const double low = ranges[first + k], high = ranges[first + 3 + k];
          value[int(k)] = low + (high - low) * fraction[int(k)];
        }
        return value;
      };
      SplatValues splat;
      splat.center = in_range(0, packed_fractions(packed[packed_position]));
      splat.scales = glm::exp(in_range(6, packed_fractions(packed[packed_scale])));
      if (profile.is_flat) splat.scales.z = 0;
      splat.rotation = unpacked_rotation(packed[packed_rotation]);
      const std::uint32_t color = packed[packed_color];
      splat.opacity = packed_fraction(color, 0, 8);
      const glm::dvec3 rgb =
          in_range(12, {packed_fraction(color, 24, 8), packed_fraction(color, 16, 8),
                        packed_fraction(color, 8, 8)});
      coefficients[0] = glm::vec3((rgb - 0.5) / harmonics::y00);
      for (std::size_t k = 0; k < rest; ++k)
        for (std::size_t c = 0; c < 3; ++c)
          coefficients[k + 1][int(c)] = unpacked_coefficient(rest_[3 * (i * rest + k) + c]);
      builder.add(splat, std::span(coefficients).first(rest + 1));
    }
    return builder.finish(profile.profile, "compressed PLY");
  }

  template <class Row>
  void take_rows(std::vector<Row>& rows, const PlyElement& element) {
    input_.take_memory(element.count, sizeof(Row), "the packed splats");
    rows.reserve(static_cast<std::size_t>(element.count));
  }

  Input& input_;
  const PlyHeader& header_;
  const ReadOptions& options_;
  PlyValues values_;
  std::vector<ChunkRanges> ranges_;
  std::vector<PackedSplat> packed_;
  std::vector<std::uint8_t> rest_;  // [splat][coefficient][rgb]
};

}  // namespace

bool is_compressed_ply(const PlyHeader& header) {
  const PlyElement* vertex = header.find("vertex");
  return vertex && header.find("chunk") && vertex->find("packed_position");
}

Scene read_compressed_ply(Input& input, const PlyHeader& header, const ReadOptions& options) {
  return CompressedPlyReader(input, header, options).read();
}

}  // namespace tureen
