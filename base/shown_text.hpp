// Text from files, made safe to print: it cannot control a terminal, start a new line or fill the
// screen.
#pragma once

#include <string>
#include <string_view>

namespace tureen {

/// One line. Control characters, bidirectional controls and bytes that are not UTF-8 are escaped:
/// "\n", "\u001b", "\xff". The rest is unchanged.
std::string shown_text(std::string_view text);

/// The same, shortened: a text above 1000 bytes keeps its beginning and its end, with the number of
/// omitted bytes between them.
std::string shown_line(std::string_view text);

}  // namespace tureen
