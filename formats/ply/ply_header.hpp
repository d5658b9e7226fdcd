// The text header of a PLY file: the elements with their properties, and the encoding (G. Turk,
// "The PLY Polygon File Format", 1994).
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
  PlyType type = PlyType::float32;    // of the value, or of each list element
  std::optional<PlyType> count_type;  // of the list length; an integer type
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t line = 0;  // in the header, for messages
  std::vector<PlyProperty> properties;

  /// The index of the property with this name, or nullopt.
  std::optional<std::size_t> find(std::string_view property) const;
  /// Smallest size of one row in the body, in bytes: lists are empty; in ascii each value needs one
  /// character and a separator.
  std::uint64_t min_bytes(bool ascii) const;
};

struct PlyHeader {
  enum class Encoding { ascii, little_endian, big_endian };

  Encoding encoding = Encoding::ascii;
  std::vector<PlyElement> elements;
  std::string comments;         // words separated by one space; each comment ends with LF
  std::uint64_t body = 0;       // first byte of the values
  std::uint64_t body_line = 1;  // and their line, for ascii

  /// The element with this name, or null.
  const PlyElement* find(std::string_view element) const;
};

/// Throws InputError at the element's line in the header: "element 'vertex' lacks 'x'".
[[noreturn]] void fail_element(const Input& input, const PlyElement& element,
                               const std::string& reason);

/// Whether the file begins with "ply" and a line break.
bool is_ply(std::span<const std::byte> head);

/// Reads from the start of `input`. Lines end with LF, CR or CR LF, as the first one does; comment
/// lines are kept, obj_info lines skipped; all aliases of the scalar types are supported. Throws
/// InputError with the line: an unknown keyword, encoding or type, an invalid number, extra words,
/// a header longer than 1 MiB, or elements that exceed the file.
PlyHeader read_ply_header(Input& input);

/// The same from the first bytes of a partial file, whose size is unknown: elements may exceed it.
/// Returns nullopt until the header is complete. Throws InputError.
std::optional<PlyHeader> read_ply_beginning(Input& input);

}  // namespace tureen
