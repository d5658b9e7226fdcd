// An option that takes one of a few words.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <utility>
#include <vector>

#include "formats/suggestion.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

/// Sets `value` to what the given word stands for. Any other word is a UsageError: of the words in
/// `removed`, which earlier versions had, with the hint beside them, else with the list of choices.
template <class T>
CLI::Option* add_choice(CLI::App& command, const std::string& name, T& value,
                        std::vector<std::pair<std::string, T>> choices, const std::string& help,
                        std::vector<std::pair<std::string, std::string>> removed = {}) {
  const auto choose = [name, &value, choices = std::move(choices),
                       removed = std::move(removed)](const std::string& word) {
    for (const auto& [known, hint] : removed)
      if (known == word) throw UsageError(name + " no longer takes '" + word + "'", hint);
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
