#include "formats/splat/spz.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/gtc/packing.hpp>
#include <numeric>
#include <set>

#include "base/little_endian.hpp"
#include "formats/archive/inflater.hpp"
#include "formats/common/format_remarks.hpp"
#include "formats/common/progress_meter.hpp"
#include "formats/splat/splat_builder.hpp"
#include "formats/splat/splat_remarks.hpp"
#include "formats/splat/spz_layout.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

/// Quantisation of harmonics in a way that readers must know, and axes other than those of SPZ.
constexpr std::uint32_t adobe_quantisation = 0xADBE0001, adobe_axes = 0xADBE0003;
/// Values of adobe_axes.
constexpr std::uint32_t axes_unspecified = 0, axes_of_spz = 4;

/// The largest size of extensions after the arrays of a gzip file. Known ones have at most 20
/// bytes.
constexpr std::size_t max_spz_tail = 65536;
/// A hostile file could have millions of types.
constexpr std::size_t max_named_extensions = 8;

struct SpzHeader {
  std::uint64_t version = 0, splats = 0;
  int degree = 0, fractional_bits = 0;
  unsigned flags = 0;

  /// Bytes of each array for one splat.
  std::array<std::size_t, spz_array::count> strides() const {
    return {version == 1 ? 6u : 9u,
            1,
            3,
            3,
            version < 3 ? 3u : 4u,
            3 * std::size_t(harmonics::count(degree) - 1)};
  }
};

bool is_gzip(std::span<const std::byte> head) {
  return head.size() >= 2 && head[0] == std::byte{0x1f} && head[1] == std::byte{0x8b};
}

bool has_spz_magic(std::span<const std::byte> head) {
  return head.size() >= 4 && little_number(head, 0, 4) == spz_magic;
}

/// "0xADBE0002".
std::string extension_name(std::uint32_t type) {
  std::array<char, 16> text;
  std::snprintf(text.data(), text.size(), "0x%08X", static_cast<unsigned>(type));
  return text.data();
}

/// `bytes` holds an array's part of one splat; see spz.hpp.
glm::dvec3 unpacked_position(std::span<const std::byte> bytes, const SpzHeader& header) {
  glm::dvec3 value;
  for (int k = 0; k < 3; ++k) {
    if (header.version == 1) {
      value[k] = glm::unpackHalf1x16(
          static_cast<std::uint16_t>(little_number(bytes, std::size_t(2 * k), 2)));
    } else {
      const auto fixed = static_cast<std::int32_t>(little_number(bytes, std::size_t(3 * k), 3));
      value[k] = std::ldexp(fixed >= 1 << 23 ? fixed - (1 << 24) : fixed, -header.fractional_bits);
    }
  }
  return value;
}

double unpacked_byte(std::span<const std::byte> bytes, std::size_t at) {
  return std::to_integer<int>(bytes[at]);
}

/// (x, y, z, w). Never all zeros.
glm::dvec4 unpacked_quaternion(std::span<const std::byte> bytes) {
  glm::dvec4 q(0.0);
  if (bytes.size() == 3) {
    for (int k = 0; k < 3; ++k) q[k] = std::to_integer<int>(bytes[std::size_t(k)]) / 127.5 - 1;
    q.w = std::sqrt(std::max(0.0, 1 - glm::dot(q, q)));
    return q;
  }
  auto word = static_cast<std::uint32_t>(little_number(bytes, 0, 4));
  const int largest = static_cast<int>(word >> 30);
  for (int k = 3; k >= 0; --k) {
    if (k == largest) continue;
    const double size = (word & 511) * std::sqrt(0.5) / 511;
    q[k] = word & 512 ? -size : size;
    word >>= 10;
  }
  q[largest] = std::sqrt(std::max(0.0, 1 - glm::dot(q, q)));
  return q;
}

/// The bytes of one splat in each array.
using SpzParts = std::array<std::span<const std::byte>, spz_array::count>;

/// On the axes of splat PLY.
SplatValues unpacked_splat(const SpzParts& parts, const SpzHeader& header) {
  SplatValues splat;
  splat.center = unpacked_position(parts[spz_array::positions], header) * glm::dvec3(1, -1, -1);
  for (int k = 0; k < 3; ++k)
    splat.scales[k] = std::exp(unpacked_byte(parts[spz_array::scales], std::size_t(k)) / 16 - 10);
  const glm::dvec4 q = unpacked_quaternion(parts[spz_array::rotations]);
  splat.rotation = {q.w, q.x, -q.y, -q.z};
  splat.opacity = unpacked_byte(parts[spz_array::alphas], 0) / 255;
  return splat;
}

/// `signs` are those of signs_after_turn().
void unpack_coefficients(const SpzParts& parts, std::span<const float> signs,
                         std::span<glm::vec3> coefficients) {
  const auto colors = parts[spz_array::colors], rest = parts[spz_array::rest];
  for (std::size_t c = 0; c < 3; ++c) {
    coefficients[0][int(c)] = float((unpacked_byte(colors, c) / 255 - 0.5) / 0.15);
    for (std::size_t k = 1; k < coefficients.size(); ++k)
      coefficients[k][int(c)] =
          signs[k] * float((unpacked_byte(rest, 3 * (k - 1) + c) - 128) / 128);
  }
}

class SpzReader {
 public:
  SpzReader(Input& input, const ReadOptions& options) : input_(input), options_(options) {}

  Scene read() {
    std::array<std::byte, 4> head;
    input_.seek(0);
    input_.read(head, "the header");
    input_.seek(0);
    if (is_gzip(head))
      read_gzip();
    else
      read_plain();
    Scene scene = unpack();
    if (!ignored_.empty())
      scene.info.remarks.push_back(
          {&remarks::splat_extensions_ignored,
           {{"extensions", std::vector<std::string>{ignored_.begin(), ignored_.end()}}}});
    if (trailing_ > 0)
      scene.info.remarks.push_back({&remarks::bytes_ignored, {{"bytes", trailing_}}});
    return scene;
  }

 private:
  void read_gzip() {
    Inflater inflater(input_, Inflater::Wrapper::gzip, input_.size());
    const auto fill = [&](std::span<std::byte> out) {
      if (inflater.read(out) < out.size())
        input_.fail("the gzip data are damaged, or end before the last splat");
    };
    std::array<std::byte, gzip_header_size> head;
    fill(head);
    read_header(head, 1, 3);
    make_arrays();
    fill(arrays_);
    // With room beyond the last byte, zlib reaches the end and compares the checksum.
    std::vector<std::byte> tail(max_spz_tail + 1);
    tail.resize(inflater.read(tail));
    if (tail.size() > max_spz_tail)
      input_.fail("more than " + std::to_string(max_spz_tail) + " bytes follow the splats");
    if (!inflater.at_end()) input_.fail("the gzip data are damaged or end early");
    if (header_.flags & flag_extensions)
      read_extensions(tail);
    else
      trailing_ = tail.size();
  }

  void read_plain() {
    std::array<std::byte, plain_header_size> head;
    input_.read(head, "the header");
    read_header(head, 4, 4);
    const std::uint64_t streams = little_number(head, 15, 1), table = little_number(head, 16, 4);
    if (table < plain_header_size || table > input_.size())
      input_.fail_at(16, "the table of streams does not lie within the file");
    if (header_.flags & flag_extensions)
      read_extensions(input_.read_values<std::byte>(table - plain_header_size, "the extensions"));
    input_.seek(table);
    const auto rows = input_.read_values<std::byte>(streams * spz_table_row, "the table");
    make_arrays();

    std::uint64_t stream = 0;
    std::span<std::byte> target(arrays_);
    for (const std::size_t stride : header_.strides()) {
      const std::size_t size = stride * std::size_t(header_.splats);
      if (size == 0) continue;
      if (stream == streams)
        input_.fail_at(15, "the file has " + std::to_string(streams) + " streams; one is missing");
      const std::size_t row = std::size_t(stream) * spz_table_row;
      if (little_number(rows, row + 8, 8) != size)
        input_.fail_at(table + row + 8, "stream " + std::to_string(stream) + " has " +
                                            std::to_string(little_number(rows, row + 8, 8)) +
                                            " bytes instead of " + std::to_string(size));
      decompress(little_number(rows, row, 8), target.first(size), stream++);
      target = target.subspan(size);
    }
    if (stream < streams)
      input_.fail_at(15, "the file has " + std::to_string(streams) + " streams instead of " +
                             std::to_string(stream));
    trailing_ = input_.remaining();
  }

  /// Fills `out` from the next `packed` bytes of the file.
  void decompress(std::uint64_t packed, std::span<std::byte> out, std::uint64_t stream) {
    const PassingMemory passing(input_.budget());
    const std::uint64_t place = input_.position();
    const auto source = input_.read_values<std::byte>(packed, "a stream");
    if (ZSTD_decompress(out.data(), out.size(), source.data(), source.size()) != out.size())
      input_.fail_at(place, "stream " + std::to_string(stream) + " is damaged");
  }

  void read_header(std::span<const std::byte> head, std::uint64_t oldest, std::uint64_t newest) {
    if (!has_spz_magic(head)) input_.fail_at(0, "not an SPZ file: it does not begin with NGSP");
    header_.version = little_number(head, 4, 4);
    if (header_.version < oldest || header_.version > newest)
      input_.fail_at(4,
                     "SPZ version " + std::to_string(header_.version) +
                         (newest == 4 ? " is not supported" : " is not supported in gzip files"),
                     newest == 4 ? "supported versions are 1 to 4"
                                 : "supported versions in gzip files are 1 to 3");
    header_.splats = little_number(head, 8, 4);
    // Niantic's bound: a file may expand to 1024 times its size, and a splat has at least 9 bytes.
    if (header_.splats * 9 / 1024 > input_.size())
      input_.fail_at(8, "a file of " + std::to_string(input_.size()) + " bytes cannot hold " +
                            std::to_string(header_.splats) + " splats");
    header_.degree = std::to_integer<int>(head[12]);
    if (header_.degree > harmonics::max_degree)
      input_.fail_at(12, "harmonics of degree " + std::to_string(header_.degree) +
                             "; the largest supported degree is 4");
    header_.fractional_bits = std::to_integer<int>(head[13]);
    header_.flags = std::to_integer<unsigned>(head[14]);
  }

  void make_arrays() {
    const auto strides = header_.strides();
    const std::size_t stride = std::accumulate(strides.begin(), strides.end(), std::size_t(0));
    input_.take_memory(header_.splats, stride, "the packed splats");
    arrays_.resize(std::size_t(header_.splats) * stride);
  }

  void read_extensions(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      if (bytes.size() < 8) input_.fail("the file ends within an extension");
      const auto type = static_cast<std::uint32_t>(little_number(bytes, 0, 4));
      const std::uint64_t size = little_number(bytes, 4, 4);
      if (type == adobe_quantisation)
        input_.fail("the extension " + extension_name(type) +
                    " changes the harmonics in a way that is not supported");
      if (size > bytes.size() - 8) input_.fail("the file ends within an extension");
      const auto content = bytes.subspan(8, std::size_t(size));
      if (type == adobe_axes)
        require_axes(content);
      else if (ignored_.size() < max_named_extensions)
        ignored_.insert(extension_name(type));
      bytes = bytes.subspan(8 + content.size());
    }
  }

  void require_axes(std::span<const std::byte> content) const {
    const std::string name = "the extension " + extension_name(adobe_axes);
    if (content.size() != 4) input_.fail(name + " has not 4 bytes");
    const auto axes = little_number(content, 0, 4);
    if (axes != axes_unspecified && axes != axes_of_spz)
      input_.fail(name + " selects the axes " + std::to_string(axes) +
                  ", but only right, up, back (" + std::to_string(axes_of_spz) + ") are supported");
  }

  Scene unpack() const {
    const auto count = static_cast<std::size_t>(header_.splats);
    const auto strides = header_.strides();
    SplatBuilder builder(input_, options_, Gaussians{}, header_.degree, count);
    const auto signs = signs_after_turn();
    std::array<glm::vec3, harmonics::count(harmonics::max_degree)> coefficients;
    const auto used = std::span(coefficients).first(std::size_t(harmonics::count(header_.degree)));
    ProgressMeter meter(options_);
    for (std::size_t i = 0; i < count; ++i) {
      meter.step([&] { return double(i) / double(count); });
      SpzParts parts;
      std::span<const std::byte> rest(arrays_);
      for (std::size_t a = 0; a < spz_array::count; ++a) {
        parts[a] = rest.subspan(i * strides[a], strides[a]);
        rest = rest.subspan(count * strides[a]);
      }
      unpack_coefficients(parts, signs, used);
      builder.add(unpacked_splat(parts, header_), used);
    }
    return builder.finish(*profile_named(header_.flags & flag_antialiased ? "mip" : "3dgs"), "SPZ");
  }

  Input& input_;
  const ReadOptions& options_;
  SpzHeader header_;
  std::vector<std::byte> arrays_;  // in the order of spz_array, without gaps
  std::set<std::string> ignored_;
  std::uint64_t trailing_ = 0;
};

}  // namespace

bool is_spz(std::span<const std::byte> head) {
  if (!is_gzip(head)) return has_spz_magic(head);
  Input input = Input::memory("", head);
  std::array<std::byte, 4> start;
  Inflater inflater(input, Inflater::Wrapper::gzip, input.size());
  return inflater.read(start) == start.size() && has_spz_magic(start);
}

Scene read_spz(Input& input, const ReadOptions& options) {
  return SpzReader(input, options).read();
}

Scene read_spz(const std::filesystem::path& path, const ReadOptions& options) {
  Input input = Input::open(path);
  return read_spz(input, options);
}

}  // namespace tureen
