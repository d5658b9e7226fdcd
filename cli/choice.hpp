// An option that takes one of a few words.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <utility>
#include <vector>

#include "formats/suggestion.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

/// Sets `value` to what the given word stands for. Any other word is a UsageError that lists the
/// words.
template <class T>
CLI::Option* add_choice(CLI::App& command, const std::string& name, T& value,
                        std::vector<std::pair<std::string, T>> choices, const std::string& help) {
  const auto choose = [name, &value, choices = std::move(choices)](const std::string& word) {
    std::vector<std::string> words;
    std::string list;
    for (const auto& [known, meaning] : choices) {
      if (known == word) {
        value = meaning;
        return;
      }
      list += (words.empty() ? "" : ", ") + known;
      words.push_back(known);
    }
    throw UsageError(name + " takes " + list + ", not '" + word + "'", did_you_mean(word, words));
  };
  return command.add_option_function<std::string>(name, choose, help);
}

}  // namespace tureen::cli
