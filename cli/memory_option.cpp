#include "cli/memory_option.hpp"

#include "formats/memory_budget.hpp"
#include "formats/memory_help.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

void add_memory_option(Command& command) {
  const auto set = [](const std::string& text) { set_max_memory(parse_memory_size(text)); };
  command.add_option("--max-memory", set, max_memory_help).value_name("SIZE");
}

}  // namespace tureen::cli
