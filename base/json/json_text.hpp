// JSON documents with keys in insertion order.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace tureen {

using Json = nlohmann::ordered_json;

/// The document and a newline; in one line if `indent` is -1. Bytes that are not UTF-8 become
/// U+FFFD.
std::string json_text(const Json& document, int indent = 2);

}  // namespace tureen
