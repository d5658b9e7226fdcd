// What is known of JSON before it is parsed, so that no text can ask for more stack or memory than
// there is. All JSON that we read passes here: our own readers' and what tinygltf is given.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.hpp"
#include "base/memory_budget.hpp"

namespace tureen {

/// Deeper nesting is refused: whoever walks the value recursively must not run out of stack. The
/// deepest file that we know of, a glTF with extensions, has a dozen levels.
inline constexpr int max_json_depth = 64;

/// What a value of a parsed document takes at most, beside the letters of its texts: itself, the
/// node of the object's tree that holds it and its key, and what vectors have in reserve.
inline constexpr std::size_t json_value_bytes = 128;

/// An upper bound of the number of values and keys that a parser makes of `text`, whether it is
/// JSON or not: 1 where it stops at the first character. Throws an InputError, with the byte of
/// `file` of which `text` begins at `first_byte`, where it is nested deeper than max_json_depth.
std::uint64_t count_json_values(std::string_view text, const std::string& file,
                                std::uint64_t first_byte = 0);

/// Counts what parsing `text` will take. Throws InputError where that is too much, or nested too
/// deeply.
void take_json_memory(std::string_view text, const std::string& file, std::uint64_t first_byte,
                      MemoryBudget budget);

/// The one thing that is JSON and cannot be parsed: a number beyond the largest double. `message`
/// is the parser's, which quotes it; `text` and the rest are as above.
InputError json_number_too_large(std::string_view message, std::string_view text,
                                 const std::string& file, std::uint64_t first_byte = 0);

}  // namespace tureen
