#include "cli/options/config_options.hpp"

#include <charconv>

#include "jobs/training/training_method.hpp"

namespace tureen::cli {

namespace {

/// Negative numbers and numbers beyond 64 bits would wrap around to other seeds.
std::string refuse_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, seed);
  if (error == std::errc() && stop == end) return {};
  return "a seed must be a whole number from 0 to 18446744073709551615, not " + text;
}

Option add_method_option(Command& command, const MethodOption& option, OptionValue& value) {
  const std::string name = std::string("--") + option.name;
  const std::string named = name + (*option.value_name ? " " : "") + option.value_name;
  switch (option.type) {
    case MethodOption::Type::flag:
      return command.add_flag(name, value.flag, option.help);
    case MethodOption::Type::whole:
      return command.add_option(named, value.whole, option.help);
    case MethodOption::Type::number:
      return command.add_option(named, value.number, option.help);
    case MethodOption::Type::path:
      return command.add_option(named, value.text, option.help);
    case MethodOption::Type::word:
      break;
  }
  const auto choose = [&](std::size_t index) { value.text = option.words[index]; };
  return add_word_option(command, named, option.words, choose, option.help);
}

}  // namespace

void add_config_options(Command& command, TrainingOptions& options) {
  std::vector<std::string> names;
  std::string summaries;
  for (const TrainingMethodInfo* method : training_methods()) {
    names.emplace_back(method->name);
    summaries += (summaries.empty() ? "" : "; ") + names.back() +
                 (names.size() == 1 ? " (default)" : "") + ": " + method->summary;
  }
  std::vector<std::pair<const TrainingMethodInfo*, const MethodOption*>> meanings;  // of names
  for (const TrainingMethodInfo* method : training_methods()) meanings.push_back({method, nullptr});
  for (const TrainingMethodInfo* method : training_methods())
    for (const auto& [alias, flag] : method->aliases) {
      names.emplace_back(alias);
      meanings.push_back({method, flag});
      summaries += "; " + names.back() + ": " + method->name + (flag ? " --" : "") +
                   (flag ? flag->name : "");
    }
  const auto choose = [&options, meanings](std::size_t index) {
    const auto& [method, flag] = meanings[index];
    options.method = method;
    if (flag) options.own[flag->name].flag = true;
  };
  add_word_option(command, "--method NAME", names, choose, summaries);
  command.add_option("--config FILE", options.file,
                     "JSON file with constants; --list-config lists them");
  command.add_option("--steps N", options.steps,
                     "number of optimiser steps; --list-config prints each method's default; "
                     "overrides the minutes in --config");
  command.add_option("--seed N", options.seed, "seed of the random numbers; 0 by default",
                     refuse_seed);
  command.add_option(
      "--init WHERE", options.begin,
      "initial primitives: random, points (structure-from-motion points in the dataset), or a "
      "scene to continue from; by default points if the dataset has them, else points found in the "
      "photographs, or random ones (diffsoup, and neural always: Gaussians that are trained "
      "first)");
  for (const auto& [option, methods] : all_method_options()) {
    Option added = add_method_option(command, *option, options.own[option->name]);
    if (methods.size() < training_methods().size())
      added.group("Options of " + names_of(methods, ", "));
  }
}

}  // namespace tureen::cli
