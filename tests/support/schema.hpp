// Documents held against the JSON schemas of docs/.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace tureen::test {

/// What in `document` breaks docs/NAME, a line each; empty when nothing does. Throws
/// std::runtime_error where the schema itself cannot be read.
std::string schema_violations(const nlohmann::json& document, const std::string& name);

}  // namespace tureen::test
