#include "image/exr.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace tureen {

namespace {

/// All numbers of the format are little-endian.
class Bytes {
 public:
  template <class T>
  void add(T value) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto bytes = std::as_bytes(std::span(&value, 1));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  /// With a zero at its end.
  void add_name(std::string_view text) {
    for (const char c : text) add(c);
    add('\0');
  }
  template <class... Values>
  void attribute(std::string_view name, std::string_view type, const Values&... values) {
    add_name(name);
    add_name(type);
    add(std::int32_t((sizeof values + ...)));
    (add(values), ...);
  }
  void add_all(const Bytes& other) {
    bytes_.insert(bytes_.end(), other.bytes_.begin(), other.bytes_.end());
  }
  void add_floats(std::span<const float> values) {
    const auto bytes = std::as_bytes(values);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  std::size_t size() const { return bytes_.size(); }
  std::vector<std::byte> take() && { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

void add_channels(Bytes& header, std::span<const ExrChannel> channels) {
  constexpr std::int32_t float_type = 2;
  Bytes list;
  for (const ExrChannel& channel : channels) {
    list.add_name(channel.name);
    list.add(float_type);
    list.add(std::int32_t(0));  // not linear, and three reserved bytes
    list.add(std::int32_t(1));  // one sample for each column,
    list.add(std::int32_t(1));  // and row
  }
  list.add('\0');
  header.add_name("channels");
  header.add_name("chlist");
  header.add(std::int32_t(list.size()));
  header.add_all(list);
}

}  // namespace

std::vector<std::byte> encode_exr(int width, int height, std::vector<ExrChannel> channels) {
  assert(!channels.empty());
  const std::size_t columns = std::size_t(width), rows = std::size_t(height);
  assert(std::all_of(channels.begin(), channels.end(), [&](const ExrChannel& channel) {
    return channel.values.size() == columns * rows;
  }));
  std::sort(channels.begin(), channels.end(),
            [](const ExrChannel& a, const ExrChannel& b) { return a.name < b.name; });

  Bytes file;
  file.add(std::int32_t(20000630));  // OpenEXR,
  file.add(std::int32_t(2));         // version 2, scanlines
  add_channels(file, channels);
  const std::int32_t right = width - 1, bottom = height - 1, zero = 0;
  file.attribute("compression", "compression", std::uint8_t(0));
  file.attribute("dataWindow", "box2i", zero, zero, right, bottom);
  file.attribute("displayWindow", "box2i", zero, zero, right, bottom);
  file.attribute("lineOrder", "lineOrder", std::uint8_t(0));  // from the top
  file.attribute("pixelAspectRatio", "float", 1.0f);
  file.attribute("screenWindowCenter", "v2f", 0.0f, 0.0f);
  file.attribute("screenWindowWidth", "float", 1.0f);
  file.add('\0');

  const std::size_t row_bytes = channels.size() * columns * sizeof(float);
  const std::size_t block = 2 * sizeof(std::int32_t) + row_bytes;
  const std::size_t first = file.size() + rows * sizeof(std::uint64_t);
  for (std::size_t y = 0; y < rows; ++y) file.add(std::uint64_t(first + y * block));
  for (std::size_t y = 0; y < rows; ++y) {
    file.add(std::int32_t(y));
    file.add(std::int32_t(row_bytes));
    for (const ExrChannel& channel : channels)
      file.add_floats(channel.values.subspan(y * columns, columns));
  }
  return std::move(file).take();
}

}  // namespace tureen
