// Places of errors: past the end of a file, and in a JSON text.
#include "base/input.hpp"

#include <gtest/gtest.h>

#include <span>
#include <string_view>
#include <vector>

#include "base/json/json_view.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace input_test {

using test::error_of;
using test::ErrorAt;

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

TEST(Input, ReadsInOrderAndSeeks) {
  Input input = Input::memory("six", bytes_of("abcdef"));
  EXPECT_EQ(input.read_value<char>("a letter"), 'a');
  EXPECT_EQ(input.position(), 1u);
  EXPECT_EQ(input.remaining(), 5u);
  input.seek(6);  // the end is a place, too
  EXPECT_EQ(input.remaining(), 0u);
  EXPECT_TRUE(input.read_rest().empty());
  EXPECT_THAT(error_of([&] { input.seek(7); }), ErrorAt("six@6", 7, 6));
  input.seek(4);
  EXPECT_THAT(error_of([&] { input.read_values<char>(3, "letters"); }), ErrorAt("six@4", 3));
  EXPECT_EQ(input.read_values<char>(2, "letters"), (std::vector<char>{'e', 'f'}));
}

TEST(ParseJson, NamesTheByteOfItsError) {
  EXPECT_EQ(parse_json("{\"a\": [1, 2]}", "a.json")["a"][1], 2);
  // The parser stops at the closing brace, byte 5; it lies 100 bytes into the file.
  EXPECT_THAT(error_of([] { parse_json("{\"a\":}", "a.json", 100); }), ErrorAt("a.json@105"));
  EXPECT_THAT(error_of([] { parse_json("[1 2]", "a.json"); }), ErrorAt("a.json@3"));
}

}  // namespace input_test
}  // namespace tureen
