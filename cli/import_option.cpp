#include "cli/import_option.hpp"

#include <algorithm>

#include "soup/error.hpp"

namespace tureen::cli {

CLI::Option* add_import_option(CLI::App& command, std::vector<std::string>& files,
                               const std::string& description) {
  return command.add_option("--import", files, description)
      ->option_text("FILE.json")
      ->type_size(1)
      ->allow_extra_args(false);
}

void require_no_measuring(const CLI::App& command, const std::vector<std::string>& allowed) {
  for (const CLI::Option* option : command.get_options())
    if (option->count() > 0 &&
        std::find(allowed.begin(), allowed.end(), option->get_name()) == allowed.end())
      throw UsageError(option->get_name() + " means nothing with --import: nothing is measured");
}

}  // namespace tureen::cli
