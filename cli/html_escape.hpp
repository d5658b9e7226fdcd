// Text within HTML.
#pragma once

#include <string>

namespace tureen::cli {

/// Text for elements and attributes of HTML and XML. What neither may hold (control characters,
/// bytes that are no UTF-8) becomes U+FFFD.
std::string html_escaped(const std::string& text);

}  // namespace tureen::cli
