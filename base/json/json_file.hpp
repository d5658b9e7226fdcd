// Reading small JSON files from untrusted sources, with places in the errors.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/input.hpp"

namespace tureen {

/// Size limit in bytes; larger files are rejected.
inline constexpr std::uint64_t max_json_bytes = 16u << 20;

/// The treatment of an object with the same key twice, which JSON leaves open.
enum class RepeatedKeys {
  last_counts,  // as most readers do
  refused,      // for files written by hand
};

/// The treatment of NaN, infinities and numbers that no double holds, which programs write without
/// a JSON library.
enum class NonFinite {
  refused,
  null,  // one bad number must not cost the file
};

/// Parses the whole input. Throws InputError with the byte if the text is not JSON or exceeds the
/// limits of base/json/json_limits.hpp.
nlohmann::json read_json(Input& input, RepeatedKeys repeated = RepeatedKeys::last_counts,
                         NonFinite non_finite = NonFinite::refused);

/// A finite float. Otherwise throws an InputError that names `what`.
float json_float(const nlohmann::json& value, const std::string& file, const std::string& what);

/// An array of exactly `count` finite floats.
std::vector<float> json_floats(const nlohmann::json& value, std::size_t count,
                               const std::string& file, const std::string& what);

/// The value under `key`. Throws InputError if `object` is not an object or lacks the key.
const nlohmann::json& json_at(const nlohmann::json& object, const char* key,
                              const std::string& file);

}  // namespace tureen
