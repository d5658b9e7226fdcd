#include "formats/archive/npy_array.hpp"

#include <cassert>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <set>
#include <string_view>

#include "base/little_endian.hpp"
#include "base/shown_text.hpp"

namespace tureen {

namespace {

/// numpy pads headers to 64 bytes; more are those of structured types.
constexpr std::size_t max_npy_header = 65536;

/// The content of a header: {'descr': '<f8', 'fortran_order': False, 'shape': (16, 3), }
struct NpyHeader {
  std::string type;
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
};

/// Reads the tokens of a header. Every function returns whether it found its token, and consumes
/// only then.
class NpyHeaderText {
 public:
  explicit NpyHeaderText(std::string_view text) : rest_(text) {}

  bool take(std::string_view token) {
    while (!rest_.empty() && (rest_[0] == ' ' || rest_[0] == '\n')) rest_.remove_prefix(1);
    if (rest_.substr(0, token.size()) != token) return false;
    rest_.remove_prefix(token.size());
    return true;
  }
  bool quoted(std::string& text) {
    if (!take("'")) return false;
    const std::size_t end = rest_.find('\'');
    if (end == rest_.npos) return false;
    text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return true;
  }
  bool boolean(bool& value) {
    value = take("True");
    return value || take("False");
  }
  bool tuple(std::vector<std::uint64_t>& values) {
    if (!take("(")) return false;
    while (!take(")")) {
      take("");  // blanks
      std::uint64_t value = 0;
      const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
      if (error != std::errc()) return false;
      rest_.remove_prefix(std::size_t(end - rest_.data()));
      values.push_back(value);
      if (!take(",")) return take(")");
    }
    return true;
  }
  bool at_end() { return take("") && rest_.empty(); }

 private:
  std::string_view rest_;
};

std::optional<NpyHeader> parsed_npy_header(std::string_view text) {
  NpyHeaderText tokens(text);
  NpyHeader header;
  std::set<std::string> keys;
  if (!tokens.take("{")) return std::nullopt;
  while (!tokens.take("}")) {
    std::string key;
    if (!tokens.quoted(key) || !keys.insert(key).second || !tokens.take(":")) return std::nullopt;
    const bool is_valid = key == "descr"           ? tokens.quoted(header.type)
                          : key == "fortran_order" ? tokens.boolean(header.fortran_order)
                          : key == "shape"         ? tokens.tuple(header.shape)
                                                   : false;
    if (!is_valid) return std::nullopt;
    if (tokens.take(",")) continue;
    if (!tokens.take("}")) return std::nullopt;
    break;
  }
  return keys.size() == 3 && tokens.at_end() ? std::optional(header) : std::nullopt;
}

const ZipEntry& entry_named(const ZipArchive& archive, const std::string& name) {
  if (const ZipEntry* entry = archive.find(name)) return *entry;
  throw InputError({archive.name()}, "the archive has no \"" + name + "\"");
}

}  // namespace

NpyArray::NpyArray(ZipArchive& archive, const std::string& name)
    : archive_(archive),
      entry_(entry_named(archive, name + ".npy")),
      bytes_(archive.read_all(entry_, std::numeric_limits<std::uint64_t>::max())) {
  read_header();
}

void NpyArray::read_header() {
  constexpr std::string_view magic = "\x93NUMPY";
  const std::string_view text(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
  if (text.size() < 8 || text.substr(0, magic.size()) != magic) fail("is not in the .npy format");
  const int version = std::to_integer<int>(bytes_[6]);
  if (version < 1 || version > 3)
    fail("has version " + std::to_string(version) + " of .npy; versions 1 to 3 are supported");
  const std::size_t length_size = version == 1 ? 2 : 4;
  const std::size_t begin = 8 + length_size;
  const std::uint64_t length = text.size() < begin ? 0 : little_number(bytes_, 8, length_size);
  if (text.size() < begin || length > text.size() - begin || length > max_npy_header)
    fail("ends within its header");
  data_ = begin + static_cast<std::size_t>(length);
  const auto header = parsed_npy_header(text.substr(begin, data_ - begin));
  if (!header)
    fail("has a header that does not describe an array of numbers: " +
         shown_line(text.substr(begin, data_ - begin)));
  set_type(header->type);
  by_columns_ = header->fortran_order;
  if (header->shape.empty() || header->shape.size() > 2)
    fail("has " + std::to_string(header->shape.size()) + " dimensions; 1 or 2 are supported");
  const std::uint64_t rows = header->shape[0],
                      columns = header->shape.size() == 2 ? header->shape[1] : 1;
  const std::uint64_t held = (text.size() - data_) / size_;
  if ((rows > 0 && columns > held / rows) || rows * columns * size_ != text.size() - data_)
    fail("holds " + std::to_string(text.size() - data_) + " bytes, which are not " +
         std::to_string(rows) + " x " + std::to_string(columns) + " numbers");
  rows_ = static_cast<std::size_t>(rows);
  columns_ = static_cast<std::size_t>(columns);
}

void NpyArray::set_type(const std::string& type) {
  // The byte order ('|' for single bytes), the kind and the size.
  const std::size_t size = type.size() == 3 ? std::size_t(type[2] - '0') : 0;
  const char kind = size > 0 ? type[1] : '?';
  const bool is_float = kind == 'f' && (size == 4 || size == 8);
  const bool is_integer =
      (kind == 'i' || kind == 'u') && (size == 1 || size == 2 || size == 4 || size == 8);
  if ((!is_float && !is_integer) || type[0] != (size == 1 ? '|' : '<'))
    fail("has the type '" + shown_line(type) + "', which is not supported");
  kind_ = is_float ? Kind::floats : kind == 'i' ? Kind::integers : Kind::naturals;
  size_ = size;
}

double NpyArray::at(std::size_t row, std::size_t column) const {
  assert(row < rows_ && column < columns_);
  const std::size_t index = by_columns_ ? column * rows_ + row : row * columns_ + column;
  const std::size_t place = data_ + index * size_;
  const std::uint64_t bits = little_number(bytes_, place, size_);
  switch (kind_) {
    case Kind::floats: {
      if (size_ == 4) return double(little_float(bytes_, place));
      double value;
      std::memcpy(&value, &bits, sizeof value);
      return value;
    }
    case Kind::integers: {
      // Moves the sign to the highest bit and back.
      const auto shift = 64 - 8 * size_;
      return double(static_cast<std::int64_t>(bits << shift) >> shift);
    }
    case Kind::naturals:
      break;
  }
  return double(bits);
}

void NpyArray::fail(const std::string& reason) const { archive_.fail_in(entry_, reason); }

}  // namespace tureen
