// --import: results of earlier runs are told, and nothing is measured.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace tureen::cli {

/// The option, once for each file. The list stays empty where nothing is imported; it must outlive
/// the command.
CLI::Option* add_import_option(CLI::App& command, std::vector<std::string>& files,
                               const std::string& description);

/// With --import only the options of these names mean anything; throws UsageError with the first
/// other one that was given, arguments such as SCENE among them.
void require_no_measuring(const CLI::App& command, const std::vector<std::string>& allowed);

}  // namespace tureen::cli
