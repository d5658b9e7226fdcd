#include "cli/options/memory_option.hpp"

#include "base/memory_budget.hpp"
#include "base/memory_help.hpp"

namespace tureen::cli {

void add_memory_option(Command& command, std::function<void(std::uint64_t)> also) {
  const auto set = [also = std::move(also)](const std::string& text) {
    const std::uint64_t bytes = parse_memory_size(text);
    set_max_memory(bytes);
    if (also) also(bytes);
  };
  command.add_option("--max-memory SIZE", set, max_memory_help);
}

}  // namespace tureen::cli
