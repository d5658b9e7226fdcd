#include "cli/program.hpp"

#include <algorithm>
#include <new>
#include <sstream>

#include "base/error.hpp"
#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/options/arguments.hpp"
#include "cli/report.hpp"
#include "cli/version.hpp"

namespace tureen::cli {

namespace {

ExitCode exit_code_of(const std::exception& error) {
  if (dynamic_cast<const UsageError*>(&error)) return ExitCode::usage;
  if (dynamic_cast<const InputError*>(&error)) return ExitCode::bad_input;
  if (dynamic_cast<const ContextError*>(&error)) return ExitCode::no_context;
  return ExitCode::other;
}

}  // namespace

void add_commands(Command& program, const std::vector<std::string>& arguments) {
  add_render(program);
  add_trace(program);
  add_view(program);
  add_cameras(program);
  add_train(program, arguments);
  add_info(program);
  add_convert(program);
  add_compare(program);
  add_eval(program);
  add_bench(program, arguments);
  add_tradeoff(program, arguments);
  add_report(program);
}

int run_program(int argc, char** argv) {
  catch_interrupts();
  CommandLine line("tureen", "Trains, draws, measures and converts triangle soups and splats.");
  Command program = line.program();
  program.add_text_flag(
      "--version", [] { return std::string("tureen ") + program_version(); },
      "Display program version information and exit");
  program.footer(R"(Examples:
  tureen render soup.glb -o image.png
  tureen info soup.glb
  tureen view soup.glb
  tureen COMMAND --help               options and examples of a command

Exit codes: 0 done, 1 a comparison or check failed, 2 wrong usage, 3 invalid input,
4 no OpenGL context, display or requested GPU, 5 any other error.)");

  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  add_commands(program, arguments);

  if (arguments.empty()) {
    std::istringstream help(line.help());
    for (std::string text; std::getline(help, text);) say(text);
    return int(ExitCode::usage);
  }
  Action action;
  try {
    action = line.parse(arguments);
  } catch (const UsageError& error) {
    say_error(std::string("tureen: ") + error.what());
    const std::string command = line.chosen_command();
    say_error("Try: tureen " + (command.empty() ? "" : command + " ") + "--help");
    return int(ExitCode::usage);
  }

  try {
    return int(action());
  } catch (const Interrupted&) {
    say_error("tureen: interrupted");
    return int(ExitCode::other);
  } catch (const std::bad_alloc&) {
    say_error("tureen: out of memory");
    return int(ExitCode::other);
  } catch (const std::exception& error) {
    say_error(std::string("tureen: ") + error.what());
    return int(exit_code_of(error));
  }
}

}  // namespace tureen::cli
