#include "formats/archive/zip_writer.hpp"

#include <limits>

#include "base/crc32.hpp"
#include "base/error.hpp"

namespace tureen {

namespace {

constexpr std::size_t written_local_size = 30;
/// An extra field of this kind holds only padding; its number is that of USDZ.
constexpr std::uint32_t padding_kind = 0x1986;
/// 1980-01-01, the first day that the format knows: equal scenes make equal files.
constexpr std::uint32_t no_date = 0x0021'0000;

}  // namespace

void ZipWriter::number(std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) output_.write_value(std::uint8_t(value >> (8 * i)));
}

/// The fields that both headers of a file have, from the flags to the length of its name.
void ZipWriter::head(const Entry& entry) {
  number(20, 2);  // version 2.0
  number(0, 2);
  number(0, 2);  // stored
  number(no_date, 4);
  number(entry.sum, 4);
  number(entry.size, 4);
  number(entry.size, 4);
  number(entry.name.size(), 2);
}

void ZipWriter::add(const std::string& name, std::span<const std::byte> content) {
  const std::uint64_t place = output_.position();
  std::size_t padding = 0;
  const std::uint64_t begin = place + written_local_size + name.size();
  if (begin % alignment_ != 0) {
    padding = 4;  // at least the head of the field
    padding += (alignment_ - (begin + padding) % alignment_) % alignment_;
  }
  if (begin + padding + content.size() > std::numeric_limits<std::uint32_t>::max() ||
      entries_.size() == std::numeric_limits<std::uint16_t>::max())
    throw OutputError({name}, "the archive would exceed 4 GiB");
  entries_.push_back(
      {name, crc32_of(content), std::uint32_t(content.size()), std::uint32_t(place)});
  number(0x04034b50, 4);
  head(entries_.back());
  number(padding, 2);
  output_.write(std::string_view(name));
  if (padding > 0) {
    number(padding_kind, 2);
    number(padding - 4, 2);
    for (std::size_t i = 4; i < padding; ++i) number(0, 1);
  }
  output_.write(content);
}

void ZipWriter::finish() {
  const std::uint64_t place = output_.position();
  for (const Entry& entry : entries_) {
    number(0x02014b50, 4);
    number(20, 2);
    head(entry);
    number(0, 2);  // no extra field
    number(0, 2);  // no comment
    number(0, 2);  // first disk
    number(0, 2);
    number(0, 4);  // no attributes
    number(entry.header, 4);
    output_.write(std::string_view(entry.name));
  }
  const std::uint64_t size = output_.position() - place;
  if (place + size > std::numeric_limits<std::uint32_t>::max())
    throw OutputError({}, "the archive would exceed 4 GiB");
  number(0x06054b50, 4);
  number(0, 4);
  number(entries_.size(), 2);
  number(entries_.size(), 2);
  number(size, 4);
  number(place, 4);
  number(0, 2);
}

}  // namespace tureen
