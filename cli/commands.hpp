// The subcommands, one file each. A new one needs a function here, its file, and a line in
// program.cpp.
#pragma once

#include <string>
#include <vector>

#include "cli/options/arguments.hpp"

namespace tureen::cli {

/// `arguments`: arguments of the program, which the result stores.
void add_bench(Command& program, std::vector<std::string> arguments);
void add_cameras(Command& program);
void add_compare(Command& program);
void add_convert(Command& program);
void add_eval(Command& program);
void add_info(Command& program);
void add_render(Command& program);
void add_report(Command& program);
void add_trace(Command& program);
void add_tradeoff(Command& program, std::vector<std::string> arguments);
void add_train(Command& program, std::vector<std::string> arguments);
void add_view(Command& program);

/// Adds all commands.
void add_commands(Command& program, const std::vector<std::string>& arguments);

}  // namespace tureen::cli
