// The text at the head of a PLY file: which elements follow, with which properties, in which
// encoding (G. Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/input.hpp"

namespace tureen {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr std::size_t size_of(PlyType type) {
  return type <= PlyType::uint8     ? 1
         : type <= PlyType::uint16  ? 2
         : type <= PlyType::float32 ? 4
                                    : 8;
}
constexpr bool is_integer(PlyType type) { return type <= PlyType::uint32; }

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;    // of the value, or of each in the list
  std::optional<PlyType> count_type;  // of a list's length; an integer
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t line = 0;  // of the header, for messages
  std::vector<PlyProperty> properties;

  /// The index of the property of this name, or nothing.
  std::optional<std::size_t> find(std::string_view property) const;
  /// The fewest bytes that one row takes in the body: lists empty, and, in a text, one character
  /// and a separator a value.
  std::uint64_t least_bytes(bool ascii) const;
};

struct PlyHeader {
  enum class Encoding { ascii, little_endian, big_endian };

  Encoding encoding = Encoding::ascii;
  std::vector<PlyElement> elements;
  std::uint64_t body = 0;       // byte at which the values begin
  std::uint64_t body_line = 1;  // and the line, for a text

  /// The element of this name, or null.
  const PlyElement* find(std::string_view element) const;
};

/// Whether a file begins like a PLY: "ply" and a line break.
bool is_ply(std::span<const std::byte> head);

/// Reads from the start of `input`. Lines may end with LF, CR or CR LF, as the first one does;
/// comment and obj_info lines are passed over; all aliases of the scalar types are known. Throws
/// InputError with the line: an unknown keyword, encoding or type, a number that is none, words
/// left over, a header that does not end within 1 MiB, or elements that do not fit into the file.
PlyHeader read_ply_header(Input& input);

}  // namespace tureen
