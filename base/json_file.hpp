// JSON from untrusted hands: what a reader of small JSON files needs, with places in its errors.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/input.hpp"

namespace tureen {

/// Files of more bytes are refused.
inline constexpr std::uint64_t max_json_bytes = 16u << 20;

/// What an object with the same key twice means. JSON leaves it open.
enum class RepeatedKeys {
  last_counts,  // as most readers have it
  refused,      // for what people write by hand
};

/// Parses the whole input. Throws an InputError with the byte where the text is no JSON, or does
/// not keep to the limits of base/json_limits.hpp.
nlohmann::json read_json(Input& input, RepeatedKeys repeated = RepeatedKeys::last_counts);

/// A finite float; throws an InputError that names `what` otherwise.
float json_float(const nlohmann::json& value, const std::string& file, const std::string& what);

/// An array of exactly `count` finite floats.
std::vector<float> json_floats(const nlohmann::json& value, std::size_t count,
                               const std::string& file, const std::string& what);

/// The value under `key`; throws an InputError where `object` is no object or lacks it.
const nlohmann::json& json_at(const nlohmann::json& object, const char* key,
                              const std::string& file);

}  // namespace tureen
