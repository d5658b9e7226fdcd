// Escapes text for HTML.
#pragma once

#include <string>

namespace tureen {

/// Text for elements and attributes of HTML and XML. Control characters and bytes that
/// are not UTF-8 become U+FFFD.
std::string html_escaped(const std::string& text);

}  // namespace tureen
