#include "cli/options/memory_option.hpp"

#include "base/error.hpp"
#include "base/memory_budget.hpp"
#include "base/memory_help.hpp"

namespace tureen::cli {

void add_memory_option(Command& command) {
  const auto set = [](const std::string& text) { set_max_memory(parse_memory_size(text)); };
  command.add_option("--max-memory", set, max_memory_help).value_name("SIZE");
}

}  // namespace tureen::cli
