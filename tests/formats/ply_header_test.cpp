#include "formats/ply/ply_header.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/formats/format_testing.hpp"

namespace tureen {
namespace ply_header_test {

using test::error_of;
using test::ErrorAt;
using test::ErrorIn;
using test::input_of;
using test::Refusal;

PlyHeader read(const std::string& text) {
  Input input = input_of(text, "a.ply");
  return read_ply_header(input);
}

std::optional<Refusal> message(const std::string& text) {
  return error_of([&] { read(text); });
}

TEST(PlyHeader, ReadsElementsAndProperties) {
  const std::string text =
      "ply\ncomment one\nformat binary_big_endian 1.0\nobj_info two\n\nelement vertex 2\n"
      "property double x\nproperty list uint8 int16 neighbours\nelement face 0\nend_header\n";
  const PlyHeader header = read(text + std::string(100, '\n'));
  EXPECT_EQ(header.encoding, PlyHeader::Encoding::big_endian);
  EXPECT_EQ(header.body, text.size());
  EXPECT_EQ(header.body_line, 11u);
  ASSERT_EQ(header.elements.size(), 2u);
  const PlyElement& vertex = header.elements[0];
  EXPECT_EQ(vertex.name, "vertex");
  EXPECT_EQ(vertex.count, 2u);
  EXPECT_EQ(vertex.line, 6u);
  EXPECT_EQ(vertex.min_bytes(false), 9u);
  ASSERT_EQ(vertex.properties.size(), 2u);
  EXPECT_EQ(vertex.properties[0].type, PlyType::float64);
  EXPECT_FALSE(vertex.properties[0].count_type);
  EXPECT_EQ(vertex.properties[1].type, PlyType::int16);
  EXPECT_EQ(vertex.properties[1].count_type, PlyType::uint8);
  EXPECT_EQ(vertex.find("neighbours"), 1u);
  EXPECT_EQ(vertex.find("y"), std::nullopt);
  EXPECT_EQ(header.find("face"), &header.elements[1]);
  EXPECT_EQ(header.find("edge"), nullptr);
}

TEST(PlyHeader, KnowsEveryTypeName) {
  const std::pair<const char*, PlyType> names[] = {
      {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
      {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
      {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
      {"float64", PlyType::float64}};
  for (const auto& [name, type] : names) {
    const PlyHeader header = read("ply\nformat ascii 1.0\nelement a 0\nproperty " +
                                  std::string(name) + " p\nend_header\n");
    EXPECT_EQ(header.elements[0].properties[0].type, type) << name;
  }
}

TEST(PlyHeader, EndsWhereItsOwnLineBreakEnds) {
  // The body begins with a line feed, which belongs to the header only if its line breaks are CR
  // LF.
  for (const std::string line_break : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char* line : {"ply", "format ascii 1.0", "end_header"}) text += line + line_break;
    EXPECT_EQ(read(text + "\n\n").body, text.size());
  }
}

TEST(PlyHeader, RefusesByLineAndReason) {
  const std::string start = "ply\nformat ascii 1.0\n";
  EXPECT_THAT(message(""), ErrorAt("a.ply:1", "ply"));
  EXPECT_THAT(message("plywood\n"), ErrorAt("a.ply:1", "ply"));
  EXPECT_THAT(message("ply\n"), ErrorAt("a.ply:1", "format"));
  EXPECT_THAT(message("ply\nelement vertex 0\n"), ErrorAt("a.ply:2", "format"));
  EXPECT_THAT(message("ply\nformat ascii\n"), ErrorAt("a.ply:2", "format"));
  EXPECT_THAT(message("ply\nformat binary_mixed_endian 1.0\n"),
              ErrorAt("a.ply:2", "binary_mixed_endian"));
  EXPECT_THAT(message("ply\nformat ascii 2.0\n"), ErrorAt("a.ply:2", "2.0", "1.0"));
  EXPECT_THAT(message(start), ErrorAt("a.ply:2", "end_header"));
  EXPECT_THAT(message(start + "end_header"), ErrorAt("a.ply:3", "end_header"));
  EXPECT_THAT(message(start + "end_header x\n"), ErrorAt("a.ply:3", "x", "end_header"));
  EXPECT_THAT(message(start + "\x01odd\n"), ErrorAt("a.ply:3", ".odd", "end_header"));
  EXPECT_THAT(message(start + "element vertex 4 5\n"), ErrorAt("a.ply:3", 5, "element"));
  EXPECT_THAT(message(start + "element vertex 4x\n"), ErrorAt("a.ply:3", "4x"));
  EXPECT_THAT(message(start + "element vertex -1\n"),
              ErrorAt("a.ply:3", "vertex", -1, "4294967295"));
  EXPECT_THAT(message(start + "element vertex 4294967296\n"),
              ErrorAt("a.ply:3", "vertex", "4294967296", "4294967295"));
  EXPECT_THAT(message(start + "element a 0\nelement a 0\n"), ErrorAt("a.ply:4", "a"));
  EXPECT_THAT(message(start + "property int x\n"), ErrorAt("a.ply:3"));
  EXPECT_THAT(message(start + "element a 0\nproperty float16 x\n"), ErrorAt("a.ply:4", "float16"));
  EXPECT_THAT(message(start + "element a 0\nproperty list float int x\n"),
              ErrorAt("a.ply:4", "float"));
  EXPECT_THAT(message(start + "element a 0\nproperty list int x\n"),
              ErrorAt("a.ply:4", "property list"));
  EXPECT_THAT(message(start + "element a 4000000000\nproperty int x\nend_header\n1"),
              ErrorAt("a.ply:3", "4000000000", "a", "8000000000", 1));
  EXPECT_THAT(message(start + std::string(2 << 20, '\n')),
              ErrorAt("a.ply:1048557", "end_header", 1));
}

TEST(PlyHeader, SaysThatItIsTooLongWhereverALineIsCut) {
  const std::string line = "property int x\n";
  std::string lines;
  while (lines.size() < (1 << 20)) lines += line;
  for (std::size_t shift = 0; shift < line.size(); ++shift) {
    EXPECT_THAT(message("ply\nformat ascii 1.0\ncomment " + std::string(shift, '-') +
                        "\nelement a 0\n" + lines + "end_header\n"),
                ErrorIn("a.ply", "end_header", 1));
  }
}

// Comparing each element with all earlier ones took eight seconds.
TEST(PlyHeader, TakesVeryManyElements) {
  std::string text = "ply\nformat ascii 1.0\n";
  for (int i = 0; i < 60000; ++i) text += "element e" + std::to_string(i) + " 0\n";
  const PlyHeader header = read(text + "end_header\n");
  ASSERT_EQ(header.elements.size(), 60000u);
  EXPECT_EQ(header.elements.back().name, "e59999");
  EXPECT_EQ(header.elements.back().line, 60002u);
  EXPECT_THAT(message(text + "element e0 0\nend_header\n"), ErrorAt("a.ply:60003", "e0"));
}

}  // namespace ply_header_test
}  // namespace tureen
