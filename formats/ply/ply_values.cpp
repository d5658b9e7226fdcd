#include "formats/ply/ply_values.hpp"

#include <bit>
#include <limits>

namespace tureen {

namespace {

struct Range {
  std::int64_t low, high;
};

template <class T>
constexpr Range range_of{std::numeric_limits<T>::min(), std::numeric_limits<T>::max()};

Range range(PlyType type) {
  switch (type) {
    case PlyType::int8:
      return range_of<std::int8_t>;
    case PlyType::uint8:
      return range_of<std::uint8_t>;
    case PlyType::int16:
      return range_of<std::int16_t>;
    case PlyType::uint16:
      return range_of<std::uint16_t>;
    case PlyType::int32:
      return range_of<std::int32_t>;
    default:
      return range_of<std::uint32_t>;
  }
}

constexpr std::size_t block = 64 * 1024;

}  // namespace

PlyValues::PlyValues(Input& input, const PlyHeader& header, const ReadOptions& options)
    : input_(input), meter_(options) {
  input_.seek(header.body);
  if (header.encoding == PlyHeader::Encoding::ascii) {
    scanner_.emplace(input_, TextSyntax{.first_line = header.body_line});
  } else {
    swap_ = (std::endian::native == std::endian::little) ==
            (header.encoding == PlyHeader::Encoding::big_endian);
    buffer_.resize(block);
  }
}

void PlyValues::begin_row(const PlyElement& element) {
  meter_.step([&] { return double(position()) / double(input_.size()); });
  element_ = element.name.c_str();
  if (scanner_ && !scanner_->next_content())
    scanner_->fail(std::string("the file ends before its last '") + element_ + "' element");
}

void PlyValues::end_row() {
  if (scanner_) scanner_->expect_line_end("the properties of its element");
}

double PlyValues::read_text(PlyType type) {
  if (!is_integer(type)) return scanner_->read_float("a property");
  const auto [low, high] = range(type);
  return static_cast<double>(scanner_->read_integer("a property", low, high));
}

std::uint64_t PlyValues::read_count(const PlyProperty& list) {
  const double count = read(*list.count_type);
  if (count < 0)
    fail("a list '" + list.name + "' of " + std::to_string(std::int64_t(count)) + " values");
  const auto values = static_cast<std::uint64_t>(count);
  // In ascii a value takes at least a separator and a character.
  if (values * (scanner_ ? 2 : size_of(list.type)) > remaining())
    fail("a list '" + list.name + "' of " + std::to_string(values) + " values in the last " +
         std::to_string(remaining()) + " bytes of the file");
  return values;
}

void PlyValues::skip(const PlyProperty& property) {
  const std::uint64_t count = property.count_type ? read_count(property) : 1;
  for (std::uint64_t i = 0; i < count; ++i) read(property.type);
}

void PlyValues::skip_rows(const PlyElement& element) {
  if (element.properties.empty()) return;  // it has no bytes in the body
  for (std::uint64_t i = 0; i < element.count; ++i) {
    begin_row(element);
    for (const PlyProperty& property : element.properties) skip(property);
    end_row();
  }
}

bool PlyValues::anything_left() { return scanner_ ? scanner_->next_content() : remaining() > 0; }

void PlyValues::refill(std::size_t wanted) {
  const std::size_t kept = end_ - next_;
  std::memmove(buffer_.data(), &buffer_[next_], kept);
  const std::size_t got =
      input_.read_some(std::as_writable_bytes(std::span(buffer_).subspan(kept)));
  next_ = 0;
  end_ = kept + got;
  if (end_ < wanted) fail(std::string("the file ends within its '") + element_ + "' elements");
}

void PlyValues::fail(const std::string& reason) const {
  if (scanner_) scanner_->fail(reason);
  input_.fail_at(position(), reason);
}

}  // namespace tureen
