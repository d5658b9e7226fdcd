#include "cli/program.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <new>
#include <optional>
#include <sstream>

#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/report.hpp"
#include "cli/retired.hpp"
#include "cli/version.hpp"
#include "formats/suggestion.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

namespace {

/// The subcommand that was named, or the program itself.
const CLI::App& named_command(const CLI::App& program) {
  const std::vector<const CLI::App*> commands =
      program.get_subcommands([](const CLI::App* command) { return command->parsed(); });
  return commands.empty() ? program : *commands.front();
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// The text in lines of at most `width` letters, broken between words.
std::string wrapped(const std::string& text, std::size_t width) {
  std::string result;
  std::size_t column = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (column > 0 && column + 1 + (end - begin) > width) {
      result += '\n';
      column = 0;
    } else if (column > 0) {
      result += ' ';
      ++column;
    }
    result.append(text, begin, end - begin);
    column += end - begin;
    begin = end + 1;
  }
  return result;
}

/// Help in lines that fit a terminal.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(option->get_description(), 60);
  }
};

/// What CLI11 refuses, as an error of ours.
UsageError explain(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App& command = named_command(program);
  if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
    const std::vector<std::string> extras = command.remaining(true);
    for (const std::string& extra : extras) {
      if (extra.size() < 2 || extra[0] != '-') continue;
      const std::string word = extra.substr(0, extra.find('='));
      if (const std::string instead = replacement_of(command.get_name(), word); !instead.empty())
        return UsageError(command.get_name() + " no longer has " + word, instead);
      std::vector<std::string> known;
      for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
      return UsageError(command.get_name() + " has no option " + word, did_you_mean(word, known));
    }
    if (!extras.empty()) return UsageError("'" + extras.front() + "' is one argument too many");
  }
  return UsageError(error.what());
}

int refuse(const CLI::App& program, const UsageError& error) {
  const CLI::App& command = named_command(program);
  say(std::string("tureen: ") + error.what());
  say("Try: tureen " + (&command == &program ? "" : command.get_name() + " ") + "--help");
  return int(ExitCode::usage);
}

/// The first argument that is there and says nothing, as "$UNSET" does in a shell.
std::optional<std::string> empty_argument(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    // An option whose value may be left out has an empty one then.
    if (const std::vector<std::string>& values = option->results();
        option->get_items_expected_min() > 0 &&
        std::find(values.begin(), values.end(), "") != values.end())
      return option->get_name();
  return std::nullopt;
}

/// CLI11 would take a mistyped subcommand for an argument too many.
bool is_unknown_command(const CLI::App& program, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;
  const std::vector<std::string> names = command_names(program);
  return std::find(names.begin(), names.end(), argv[1]) == names.end();
}

}  // namespace

void add_commands(CLI::App& program, Action& action, const std::vector<std::string>& arguments) {
  add_render(program, action);
  add_view(program, action);
  add_train(program, action);
  add_info(program, action);
  add_convert(program, action);
  add_compare(program, action);
  add_eval(program, action);
  add_bench(program, action, arguments);
  add_tradeoff(program, action, arguments);
  add_report(program, action);
}

int run_program(int argc, char** argv) {
  catch_interrupts();
  CLI::App program("Draws trained triangle soups.", "tureen");
  program.set_version_flag("--version", std::string("tureen ") + program_version());
  program.require_subcommand(1);
  const auto formatter = std::make_shared<HelpFormatter>();
  formatter->column_width(26);
  program.formatter(formatter);  // subcommands inherit it
  program.footer(R"(Examples:
  tureen render soup.glb -o picture.png
  tureen info soup.glb
  tureen view soup.glb
  tureen COMMAND --help               what a command takes, with examples

Exit codes: 0 done, 1 the comparison or the check failed, 2 wrong usage, 3 the input is
bad, 4 no OpenGL context, 5 anything else.)");

  Action action;
  add_commands(program, action, {argv + std::min(argc, 1), argv + argc});

  if (argc < 2) {
    std::istringstream help(program.help());
    for (std::string line; std::getline(help, line);) say(line);
    return int(ExitCode::usage);
  }
  if (is_unknown_command(program, argc, argv)) {
    if (const std::string instead = replacement_of(argv[1]); !instead.empty())
      return refuse(program,
                    UsageError(std::string("there is no longer a command ") + argv[1], instead));
    return refuse(program, UsageError(std::string("there is no command ") + argv[1],
                                      did_you_mean(argv[1], command_names(program))));
  }
  try {
    program.parse(argc, argv);
    if (const auto name = empty_argument(named_command(program)))
      return refuse(program, UsageError(*name + " is empty"));
  } catch (const CLI::Success& help_or_version) {
    std::ostringstream text;
    program.exit(help_or_version, text);
    action = [text = text.str()] {
      print_text(text);
      return ExitCode::done;
    };
  } catch (const UsageError& error) {
    return refuse(program, error);
  } catch (const CLI::ParseError& error) {
    return refuse(program, explain(program, error));
  }

  try {
    return int(action());
  } catch (const Interrupted&) {
    say("tureen: interrupted");
    return int(ExitCode::other);
  } catch (const std::bad_alloc&) {
    say("tureen: out of memory");
    return int(ExitCode::other);
  } catch (const std::exception& error) {
    say(std::string("tureen: ") + error.what());
    return int(exit_code_of(error));
  }
}

}  // namespace tureen::cli
