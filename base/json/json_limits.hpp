// Limits on JSON, checked before parsing, so that no text can exhaust the stack or the memory. They
// apply to all JSON: to our readers and to tinygltf.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/error.hpp"
#include "base/memory_budget.hpp"

namespace tureen {

/// Largest nesting depth; deeper texts are rejected, since recursive code must not overflow the
/// stack. The deepest known file, a glTF with extensions, has about 12 levels.
inline constexpr int max_json_depth = 64;

/// Upper bound of the memory per value of a parsed document, in bytes, excluding the characters of
/// its texts: the value, the tree node with its key, and spare capacity of vectors.
inline constexpr std::size_t json_value_bytes = 128;

/// Counts the memory needed to parse `text`. Throws InputError if it exceeds the budget or the
/// nesting is too deep.
void take_json_memory(std::string_view text, const std::string& file, std::uint64_t first_byte,
                      MemoryBudget budget);

/// The error for the only valid JSON that cannot be parsed: a number beyond the largest double.
/// `message` is the parser's, which quotes the number. The other parameters are as above.
InputError json_number_too_large(std::string_view message, std::string_view text,
                                 const std::string& file, std::uint64_t first_byte = 0);

}  // namespace tureen
