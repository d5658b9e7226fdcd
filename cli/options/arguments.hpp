// The command line: commands, their options, and the conversion of arguments to values. CLI11 does
// the parsing. In cli/, only arguments.cpp includes it, because it costs seconds of compile time
// per file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "cli/exit_code.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace tureen::cli {

/// The action of the chosen command, called after parsing.
using Action = std::function<ExitCode()>;

/// Returns why a text is rejected, as a clause that contains the text; empty if it is accepted.
using Check = std::function<std::string(const std::string& text)>;

/// Accepts decimal numbers from `least` to `most`, both included; rejects nan and 0x10.
Check between(int least, int most);
Check between(double least, double most);

/// The number that an option of type double reads from `text`; empty if it rejects the text.
std::optional<double> number_from(const std::string& text);

/// The error for a word that is not in `known`. Lists the known words; the hint is the nearest.
UsageError unknown_word(const std::string& option, const std::string& word,
                        std::span<const std::string> known);

/// A handle of an option or positional argument, valid as long as its CommandLine. Each function
/// returns the handle again.
class Option {
 public:
  /// Parsing fails without this option; `is_required` false makes it optional again.
  Option required(bool is_required = true);
  /// Parsing fails if this option was given and `other` was not.
  Option needs(const Option& other);
  /// Parsing fails if this option and `other` were given.
  Option excludes(const Option& other);
  /// Heading of the option in --help.
  Option group(const std::string& heading);
  /// A list: "a,b" is two values.
  Option split_at_commas();
  /// The same, and only one argument follows the option, not all until the next option.
  Option comma_list();
  /// A list of one value each time that the option is given.
  Option repeatable();
  /// After parsing.
  bool is_given() const;

 private:
  friend class Command;
  explicit Option(CLI::Option* option) : option_(option) {}
  static Option added(CLI::Option* option, const std::string& name, const Check& check);
  CLI::Option* option_;
};

template <class T, class... Others>
inline constexpr bool is_one_of = (std::is_same_v<T, Others> || ...);

/// Whether a variable of this type can hold an option's value.
template <class T>
inline constexpr bool holds_option =
    is_one_of<T, std::string, std::vector<std::string>, int, double, std::optional<int>,
              std::optional<std::int64_t>, std::optional<std::uint64_t>, std::optional<double>>;

/// A handle of a command, or of the program itself, valid as long as its CommandLine.
///
/// Names are "-o,--output FOLDER" for an option with its value in --help (by default the value's
/// type and requirements), and "SCENE" for a positional argument. Variables keep their value if the
/// option is not given. Variables, and references in functions, must live until the arguments are
/// parsed. `help` is the description in --help. `check` checks each value before it is stored.
class Command {
 public:
  /// Adds a subcommand with --quiet. Parsing then fails unless one is chosen.
  Command add_command(const std::string& name, const std::string& description);
  /// Sets the text at the end of --help. Commands added later inherit it.
  void footer(const std::string& text);

  /// Numbers of type double: rejects nan and infinities, after the option's checks.
  template <class T>
  requires holds_option<T> Option add_option(const std::string& name, T& value,
                                             const std::string& help, const Check& check = {});
  /// Calls `store` with the value, or with all values; it may throw UsageError.
  Option add_option(const std::string& name, const std::function<void(const std::string&)>& store,
                    const std::string& help, const Check& check = {});
  Option add_option(const std::string& name,
                    const std::function<void(const std::vector<std::string>&)>& store,
                    const std::string& help, const Check& check = {});

  /// Sets `value` to true if the flag is given.
  Option add_flag(const std::string& name, bool& value, const std::string& help);
  /// Calls `set` if the flag is given.
  Option add_flag(const std::string& name, std::function<void()> set, const std::string& help);
  /// Prints `text()` on standard output instead of running the command. At most one per command.
  void add_text_flag(const std::string& name, std::function<std::string()> text,
                     const std::string& help);

  /// An option that was added before.
  Option option(const std::string& name) const;
  bool has_option(const std::string& name) const;

  /// Sets the action of the command. It lives as long as the CommandLine.
  void does(Action action);
  /// The same for a command without options, not even --help. `action` receives all further
  /// arguments.
  void does_with_rest(std::function<ExitCode(const std::vector<std::string>&)> action);

 private:
  friend class CommandLine;
  Command(CLI::App* app, Action* chosen) : app_(app), chosen_(chosen) {}
  CLI::App* app_;
  Action* chosen_;  // of the CommandLine
};

/// An option that takes one of a few words; calls `choose` with the word's index. UsageError for
/// any other word.
Option add_word_option(Command& command, const std::string& name,
                       const std::vector<std::string>& words,
                       const std::function<void(std::size_t)>& choose, const std::string& help);

/// The same, but sets `value` to the value of the word.
template <class T>
Option add_choice(Command& command, const std::string& name, T& value,
                  std::vector<std::pair<std::string, T>> choices, const std::string& help) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.first);
  const auto choose = [&value, choices = std::move(choices)](std::size_t index) {
    value = choices[index].second;
  };
  return add_word_option(command, name, words, choose, help);
}

/// All commands of a program, and the parsed arguments.
class CommandLine {
 public:
  CommandLine(const std::string& name, const std::string& description);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// The program itself: its options and commands.
  Command program();

  /// The text of `NAME --help`.
  std::string help() const;

  /// Parses the arguments that follow the program's name. Returns the action of the chosen command.
  /// After --help and flags that print a text, returns an action that prints it. Empty if there is
  /// no action. Throws UsageError, with a hint if there is one, for the first of these:
  ///
  /// 1. an unknown command;
  /// 2. an option without its value;
  /// 3. for each given option, the program's options before the command's, each group in the order
  ///    in which the options were added: its checks, too many values, a value of the wrong type,
  ///    exceptions from its function. This step sets variables and calls functions. A flag that
  ///    prints a text ends parsing in this step. --help ends parsing at the end of this step;
  /// 4. for each option in the same order: required and missing, needs(), excludes();
  /// 5. unknown options, and unexpected arguments;
  /// 6. an empty value, such as "$UNSET" in a shell.
  Action parse(std::vector<std::string> arguments);

  /// Name of the chosen command, even if parsing failed; empty: none.
  std::string chosen_command() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tureen::cli
