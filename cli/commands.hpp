// The subcommands, one file each. Adding one: a function here, its file, a line in program.cpp.
#pragma once

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <functional>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"

namespace tureen::cli {

/// What the chosen subcommand does, set while arguments are parsed and called afterwards.
using Action = std::function<ExitCode()>;

/// `arguments` are those of the program, which the result repeats.
void add_bench(CLI::App& program, Action& action, std::vector<std::string> arguments);
void add_compare(CLI::App& program, Action& action);
void add_convert(CLI::App& program, Action& action);
void add_eval(CLI::App& program, Action& action);
void add_info(CLI::App& program, Action& action);
void add_render(CLI::App& program, Action& action);
void add_report(CLI::App& program, Action& action);
void add_tradeoff(CLI::App& program, Action& action, std::vector<std::string> arguments);
void add_train(CLI::App& program, Action& action);
void add_view(CLI::App& program, Action& action);

/// All of them.
void add_commands(CLI::App& program, Action& action, const std::vector<std::string>& arguments);

}  // namespace tureen::cli
