// Removed commands and options of earlier versions, with their replacements for error messages.
#pragma once

#include <string>

namespace tureen::cli {

/// The replacement for the option `name` ("--csv") of `command`, or with an empty `name` for the
/// command itself, as a clause: "-o FOLDER writes ..". Empty for names that never existed.
std::string replacement_of(const std::string& command, const std::string& name = "");

}  // namespace tureen::cli
