#include "cli/options/arguments.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>

#include "base/suggestion.hpp"
#include "cli/report.hpp"

namespace tureen::cli {

namespace {

template <class T>
Check check_between(T least, T most) {
  return [least, most](const std::string& text) -> std::string {
    T value{};
    // Stricter than CLI11, which also accepts hexadecimal numbers such as 0x10.
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    // Comparisons with NaN are false.
    if (error == std::errc() && rest == end && value >= least && value <= most) return {};
    return fmt::format("'{}' is not a {}number from {} to {}", text,
                       std::is_integral_v<T> ? "whole " : "", least, most);
  };
}

/// "-o,--output" of "-o,--output FOLDER".
std::string without_value(const std::string& name) { return name.substr(0, name.find(' ')); }

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
  HelpFormatter() { column_width(26); }
  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(option->get_description(), 60);
  }
  /// One empty line between groups, where CLI11 has two.
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
    for (std::size_t at; (at = text.find("\n\n\n")) != std::string::npos;) text.erase(at, 1);
    return text;
  }
};

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// The chosen command, or the program itself.
const CLI::App& named_command(const CLI::App& program) {
  const std::vector<const CLI::App*> commands =
      program.get_subcommands([](const CLI::App* command) { return command->parsed(); });
  return commands.empty() ? program : *commands.front();
}

/// CLI11 would report a mistyped command as an unexpected argument.
void require_known_command(const CLI::App& program, const std::vector<std::string>& arguments) {
  const std::vector<std::string> names = command_names(program);
  if (names.empty() || arguments.empty() || arguments.front().starts_with('-')) return;
  const std::string& word = arguments.front();
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  throw UsageError("unknown command " + word, did_you_mean(word, names));
}

/// Converts an error from CLI11.
UsageError explain(const CLI::App& command, const CLI::ParseError& error) {
  const std::vector<std::string> extras = command.remaining(true);
  if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
    for (const std::string& extra : extras) {
      if (extra.size() < 2 || extra[0] != '-') continue;
      const std::string word = extra.substr(0, extra.find('='));
      std::vector<std::string> known;
      for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
      return UsageError(command.get_name() + " has no option " + word, did_you_mean(word, known));
    }
    if (!extras.empty()) return UsageError("'" + extras.front() + "' is an unexpected argument");
  }
  return UsageError(error.what());
}

/// Throws for the first argument that is given and empty.
void require_no_empty_argument(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options())
    // If an option with an optional value is given without it, CLI11 stores an empty value.
    if (const std::vector<std::string>& values = option->results();
        option->get_items_expected_min() > 0 &&
        std::find(values.begin(), values.end(), "") != values.end())
      throw UsageError(option->get_name() + " is empty");
}

}  // namespace

Check between(int least, int most) { return check_between(least, most); }
Check between(double least, double most) { return check_between(least, most); }

std::optional<double> number_from(const std::string& text) {
  double value = 0;
  if (!CLI::detail::lexical_cast(text, value)) return std::nullopt;
  return value;
}

UsageError unknown_word(const std::string& option, const std::string& word,
                        std::span<const std::string> known) {
  return UsageError(fmt::format("{} takes {}, not '{}'", option, fmt::join(known, ", "), word),
                    did_you_mean(word, known));
}

Option Option::required(bool is_required) {
  option_->required(is_required);
  return *this;
}

Option Option::needs(const Option& other) {
  option_->needs(other.option_);
  return *this;
}

Option Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

Option Option::group(const std::string& heading) {
  option_->group(heading);
  return *this;
}

Option Option::split_at_commas() {
  option_->delimiter(',');
  return *this;
}

Option Option::comma_list() { return repeatable().split_at_commas(); }

Option Option::repeatable() {
  option_->allow_extra_args(false);
  return *this;
}

bool Option::is_given() const { return option_->count() > 0; }

Command Command::add_command(const std::string& name, const std::string& description) {
  app_->require_subcommand(1);
  Command command(app_->add_subcommand(name, description), chosen_);
  command.add_flag("--quiet", be_quiet, "print only errors and the output of --json");
  return command;
}

void Command::footer(const std::string& text) { app_->footer(text); }

Option Option::added(CLI::Option* option, const std::string& name, const Check& check) {
  // Positional arguments show no type in --help; their names are enough.
  if (option->get_positional()) option->type_name("");
  if (const std::size_t space = name.find(' '); space != name.npos)
    option->option_text(name.substr(space + 1));
  if (check) option->check(check);
  return Option(option);
}

template <class T>
requires holds_option<T> Option Command::add_option(const std::string& name, T& value,
                                                    const std::string& help, const Check& check) {
  const std::string bare = without_value(name);
  CLI::Option* option = nullptr;
  if constexpr (is_one_of<T, double, std::optional<double>>) {
    const auto store = [&value, bare](double number) {
      if (!std::isfinite(number)) throw UsageError(bare + " is not a finite number");
      value = number;
    };
    option = app_->add_option_function<double>(bare, store, help);
  } else {
    option = app_->add_option(bare, value, help);
  }
  return Option::added(option, name, check);
}
template Option Command::add_option(const std::string&, std::string&, const std::string&,
                                    const Check&);
template Option Command::add_option(const std::string&, std::vector<std::string>&,
                                    const std::string&, const Check&);
template Option Command::add_option(const std::string&, int&, const std::string&, const Check&);
template Option Command::add_option(const std::string&, double&, const std::string&, const Check&);
template Option Command::add_option(const std::string&, std::optional<int>&, const std::string&,
                                    const Check&);
template Option Command::add_option(const std::string&, std::optional<std::int64_t>&,
                                    const std::string&, const Check&);
template Option Command::add_option(const std::string&, std::optional<std::uint64_t>&,
                                    const std::string&, const Check&);
template Option Command::add_option(const std::string&, std::optional<double>&, const std::string&,
                                    const Check&);

Option Command::add_option(const std::string& name,
                           const std::function<void(const std::string&)>& store,
                           const std::string& help, const Check& check) {
  return Option::added(app_->add_option_function<std::string>(without_value(name), store, help),
                       name, check);
}

Option Command::add_option(const std::string& name,
                           const std::function<void(const std::vector<std::string>&)>& store,
                           const std::string& help, const Check& check) {
  return Option::added(
      app_->add_option_function<std::vector<std::string>>(without_value(name), store, help), name,
      check);
}

Option Command::add_flag(const std::string& name, bool& value, const std::string& help) {
  return Option(app_->add_flag(name, value, help));
}

Option Command::add_flag(const std::string& name, std::function<void()> set,
                         const std::string& help) {
  return Option(app_->add_flag_callback(name, std::move(set), help));
}

void Command::add_text_flag(const std::string& name, std::function<std::string()> text,
                            const std::string& help) {
  app_->set_version_flag(name, std::move(text), help);
}

Option Command::option(const std::string& name) const { return Option(app_->get_option(name)); }

bool Command::has_option(const std::string& name) const {
  return app_->get_option_no_throw(name) != nullptr;
}

void Command::does(Action action) {
  app_->callback([chosen = chosen_, action = std::move(action)] { *chosen = action; });
}

void Command::does_with_rest(std::function<ExitCode(const std::vector<std::string>&)> action) {
  app_->set_help_flag();
  app_->remove_option(app_->get_option("--quiet"));
  app_->prefix_command();
  app_->callback([app = app_, chosen = chosen_, action = std::move(action)] {
    *chosen = [action, rest = app->remaining()] { return action(rest); };
  });
}

Option add_word_option(Command& command, const std::string& name,
                       const std::vector<std::string>& words,
                       const std::function<void(std::size_t)>& choose, const std::string& help) {
  const auto find = [=, bare = without_value(name)](const std::string& word) {
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end()) throw unknown_word(bare, word, words);
    choose(std::size_t(found - words.begin()));
  };
  return command.add_option(name, find, help);
}

struct CommandLine::State {
  CLI::App app;
  Action chosen;
};

CommandLine::CommandLine(const std::string& name, const std::string& description)
    : state_(new State{CLI::App(description, name), {}}) {
  state_->app.formatter(std::make_shared<HelpFormatter>());  // commands inherit it
}

CommandLine::~CommandLine() = default;

Command CommandLine::program() { return {&state_->app, &state_->chosen}; }

std::string CommandLine::help() const { return state_->app.help(); }

Action CommandLine::parse(std::vector<std::string> arguments) {
  CLI::App& app = state_->app;
  require_known_command(app, arguments);
  std::reverse(arguments.begin(), arguments.end());  // CLI11 needs the reverse order
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::Success& help_or_text) {
    std::ostringstream text;
    app.exit(help_or_text, text);
    return [text = text.str()] {
      print_text(text);
      return ExitCode::done;
    };
  } catch (const CLI::ParseError& error) {
    throw explain(named_command(app), error);
  }
  require_no_empty_argument(named_command(app));
  return state_->chosen;
}

std::string CommandLine::chosen_command() const {
  const CLI::App& command = named_command(state_->app);
  return &command == &state_->app ? "" : command.get_name();
}

}  // namespace tureen::cli
