// The command line: commands, their options, and the conversion of arguments to values. CLI11 does
// the parsing; only arguments.cpp includes it, which costs seconds of compile time a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "cli/exit_code.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace tureen::cli {

/// What the chosen command does, called after parsing.
using Action = std::function<ExitCode()>;

/// The reason why a text is refused, a clause that names the text; empty where it is accepted.
using Check = std::function<std::string(const std::string& text)>;

/// Accepts decimal numbers from `least` to `most`, both included; neither nan nor 0x10.
Check between(int least, int most);
Check between(double least, double most);

/// The number that an option of type double reads from `text`; none where it refuses the text.
std::optional<double> number_from(const std::string& text);

/// The refusal of a word that is not among `known`: lists them, with the nearest as hint.
UsageError unknown_word(const std::string& option, const std::string& word,
                        std::span<const std::string> known);

/// A handle of an option or positional argument, valid as long as its CommandLine. Each function
/// returns the handle again.
class Option {
 public:
  /// Parsing fails without it; `is_required` false takes this back.
  Option required(bool is_required = true);
  /// What --help shows for its value: "N", "FOLDER". By default its type and requirements.
  Option value_name(const std::string& name);
  /// Checks each value before it is stored. Checks run in the order in which they were added.
  Option check(const Check& refusal);
  /// Parsing fails where this one was given and `other` was not.
  Option needs(const Option& other);
  /// Parsing fails where both were given.
  Option excludes(const Option& other);
  /// A list: "a,b" is two values.
  Option split_at_commas();
  /// A list: only one argument follows the option, not all until the next option.
  Option single_argument();

 private:
  friend class Command;
  explicit Option(CLI::Option* option) : option_(option) {}
  CLI::Option* option_;
};

/// A handle of a command, or of the program itself, valid as long as its CommandLine.
///
/// Names are "-o,--output" for an option and "SCENE" for a positional argument. Variables keep
/// their value where the option is not given; they, and what functions refer to, must live until
/// the arguments are parsed. `help` is the description in --help.
class Command {
 public:
  /// A command below this one, of which one has then to be chosen.
  Command add_command(const std::string& name, const std::string& description);
  /// The text at the end of --help. Commands added later inherit it.
  void footer(const std::string& text);

  Option add_option(const std::string& name, std::string& value, const std::string& help);
  Option add_option(const std::string& name, std::vector<std::string>& values,
                    const std::string& help);
  Option add_option(const std::string& name, int& value, const std::string& help);
  Option add_option(const std::string& name, std::optional<int>& value, const std::string& help);
  Option add_option(const std::string& name, std::optional<std::int64_t>& value,
                    const std::string& help);
  Option add_option(const std::string& name, std::optional<std::uint64_t>& value,
                    const std::string& help);
  /// Refuses nan and infinities, after its checks.
  Option add_option(const std::string& name, double& value, const std::string& help);
  Option add_option(const std::string& name, std::optional<double>& value, const std::string& help);
  /// Calls `store` with the value, or with all values; it may throw UsageError.
  Option add_option(const std::string& name, std::function<void(const std::string&)> store,
                    const std::string& help);
  Option add_option(const std::string& name,
                    std::function<void(const std::vector<std::string>&)> store,
                    const std::string& help);

  /// True where it is given.
  Option add_flag(const std::string& name, bool& value, const std::string& help);
  /// Calls `set` where it is given.
  Option add_flag(const std::string& name, std::function<void()> set, const std::string& help);
  /// Prints `text()` on standard output instead of what the command does. One a command.
  void add_text_flag(const std::string& name, std::function<std::string()> text,
                     const std::string& help);

  /// An option that was added before.
  Option option(const std::string& name) const;

  /// What the command does. The action lives as long as the CommandLine.
  void does(Action action);
  /// The same of a command that has no options, not even --help: `action` gets all arguments that
  /// follow.
  void does_with_rest(std::function<ExitCode(const std::vector<std::string>&)> action);

 private:
  friend class CommandLine;
  Command(CLI::App* app, Action* chosen) : app_(app), chosen_(chosen) {}
  CLI::App* app_;
  Action* chosen_;  // of the CommandLine
};

/// A word of `removed` was accepted by earlier versions; beside it stands the hint of its refusal.
using RemovedWords = std::vector<std::pair<std::string, std::string>>;

/// An option that takes one of a few words; calls `choose` with the word's index. UsageError for
/// any other word.
Option add_word_option(Command& command, const std::string& name, std::vector<std::string> words,
                       std::function<void(std::size_t)> choose, const std::string& help,
                       RemovedWords removed = {});

/// The same, which sets `value` to what stands beside the word.
template <class T>
Option add_choice(Command& command, const std::string& name, T& value,
                  std::vector<std::pair<std::string, T>> choices, const std::string& help,
                  RemovedWords removed = {}) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.first);
  const auto choose = [&value, choices = std::move(choices)](std::size_t index) {
    value = choices[index].second;
  };
  return add_word_option(command, name, std::move(words), choose, help, std::move(removed));
}

/// All commands of a program, and what was typed.
class CommandLine {
 public:
  CommandLine(const std::string& name, const std::string& description);
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// The program itself: its options and commands.
  Command program();

  /// What `NAME --help` prints.
  std::string help() const;

  /// Parses the arguments, which follow the program's name. Returns what the chosen command does,
  /// or, after --help and flags that print a text, an action that prints it; empty where there is
  /// no such command. Throws UsageError, with a hint where there is one, for the first of these:
  ///
  /// 1. a word in place of a command that is none;
  /// 2. an option that lacks its value;
  /// 3. for each option that was given, in the order in which they were added, those of the program
  ///    first: its checks, more values than it takes, a value that is not of its type, what its
  ///    function throws. Variables are set and functions called here; a flag that prints a text
  ///    ends it here, and --help after the last option;
  /// 4. for each option in the same order: required and missing, needs(), excludes();
  /// 5. unknown options, with what replaces those of earlier versions (cli/options/retired.hpp),
  /// and
  ///    arguments that nothing takes;
  /// 6. an empty value, as "$UNSET" is in a shell.
  Action parse(std::vector<std::string> arguments);

  /// The command that was chosen, even where parsing failed; empty for none.
  std::string chosen_command() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tureen::cli
