#include "base/html_escape.hpp"

#include "base/utf8.hpp"

namespace tureen {

std::string html_escaped(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    const auto [code, length] = utf8_character(text, i);
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else if (c == '\'')
      result += "&#39;";
    else if (length == 0 || (code < 0x20 && c != '\t' && c != '\n') || code == 0x7f ||
             code == 0xfffe || code == 0xffff)
      result += "\xef\xbf\xbd";
    else
      result.append(text, i, length);
    i += length ? length : 1;
  }
  return result;
}

}  // namespace tureen
