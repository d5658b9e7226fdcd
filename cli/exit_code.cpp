#include "cli/exit_code.hpp"

#include "soup/error.hpp"

namespace tureen::cli {

ExitCode exit_code_of(const std::exception& error) {
  if (dynamic_cast<const UsageError*>(&error)) return ExitCode::usage;
  if (dynamic_cast<const InputError*>(&error)) return ExitCode::bad_input;
  if (dynamic_cast<const ContextError*>(&error)) return ExitCode::no_context;
  return ExitCode::other;
}

}  // namespace tureen::cli
