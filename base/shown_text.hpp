// Text from files as it may be shown to people: it cannot steer a terminal, begin a line of its own
// or fill the screen.
#pragma once

#include <string>
#include <string_view>

namespace tureen {

/// One line. Control characters, those that turn the direction of writing, and bytes that are no
/// UTF-8 are written out: "\n", "\u001b", "\xff". The rest stays as it is.
std::string shown_text(std::string_view text);

/// The same, and of more than a thousand bytes only the beginning and the end, with how much is
/// missing between them.
std::string shown_line(std::string_view text);

}  // namespace tureen
