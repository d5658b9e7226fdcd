// The values of a PLY body in file order, for every encoding.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "base/text_scanner.hpp"
#include "formats/common/progress_meter.hpp"
#include "formats/ply/ply_header.hpp"

namespace tureen {

/// A double represents every value of every PLY type exactly; floats in ascii are rounded to float.
class PlyValues {
 public:
  /// Reads the body described by `header`, with progress. `input` and `options` must outlive this
  /// object.
  PlyValues(Input& input, const PlyHeader& header, const ReadOptions& options);

  /// Advances to the next row of an element; in ascii, to its line. The element must live until
  /// the next call.
  void begin_row(const PlyElement& element);
  /// Ends a row. In ascii the rest of the line must be empty.
  void end_row();

  /// Reads a row: calls use(slot, value) for each property that has a slot, one a property, and
  /// skips those with a negative one.
  template <class Use>
  void read_row(const PlyElement& element, const std::vector<int>& slots, const Use& use) {
    begin_row(element);
    for (std::size_t i = 0; i < slots.size(); ++i)
      if (slots[i] < 0)
        skip(element.properties[i]);
      else
        use(std::size_t(slots[i]), read(element.properties[i].type));
    end_row();
  }

  /// The next value. Integers in ascii are checked against the range of their type.
  double read(PlyType type) { return scanner_ ? read_text(type) : read_binary(type); }
  /// The length of a list, checked against the remaining bytes.
  std::uint64_t read_count(const PlyProperty& list);
  /// Skips one property; a list with all its values.
  void skip(const PlyProperty& property);
  /// Skips all rows of the element.
  void skip_rows(const PlyElement& element);

  std::uint64_t position() const {
    return scanner_ ? scanner_->position() : input_.position() - (end_ - next_);
  }
  std::uint64_t remaining() const { return input_.size() - position(); }
  /// Whether data follow the last value; in ascii, other than blanks.
  bool anything_left();

  /// Throws an InputError at the current line or byte.
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  double read_text(PlyType type);
  double read_binary(PlyType type) {
    const std::size_t size = size_of(type);
    if (end_ - next_ < size) refill(size);
    unsigned char bytes[8];
    if (swap_)
      for (std::size_t i = 0; i < size; ++i) bytes[i] = buffer_[next_ + size - 1 - i];
    else
      std::memcpy(bytes, &buffer_[next_], size);
    next_ += size;
    switch (type) {
      case PlyType::int8:
        return as<std::int8_t>(bytes);
      case PlyType::uint8:
        return as<std::uint8_t>(bytes);
      case PlyType::int16:
        return as<std::int16_t>(bytes);
      case PlyType::uint16:
        return as<std::uint16_t>(bytes);
      case PlyType::int32:
        return as<std::int32_t>(bytes);
      case PlyType::uint32:
        return as<std::uint32_t>(bytes);
      case PlyType::float32:
        return as<float>(bytes);
      case PlyType::float64:
        return as<double>(bytes);
    }
    return 0.0;  // not reached
  }
  template <class T>
  static double as(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  }
  /// Moves the rest to the front and refills the buffer. Fails if fewer than `wanted` bytes remain.
  void refill(std::size_t wanted);

  Input& input_;
  ProgressMeter meter_;
  std::optional<TextScanner> scanner_;  // for ascii
  bool swap_ = false;                   // the byte order of the file differs from the machine's
  std::vector<unsigned char> buffer_;
  std::size_t next_ = 0, end_ = 0;
  const char* element_ = "";  // of the current row, for messages
};

}  // namespace tureen
