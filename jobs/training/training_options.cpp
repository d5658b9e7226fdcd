#include "jobs/training/training_options.hpp"

#include <algorithm>

#include "jobs/training/training_method.hpp"

namespace tureen {

TrainingOptions::TrainingOptions() : method(training_methods().front()) {}

const OptionValue& TrainingOptions::operator[](const MethodOption& option) const {
  static const OptionValue none;
  const auto found = own.find(option.name);
  return found == own.end() ? none : found->second;
}

std::vector<OptionOfMethods> all_method_options() {
  std::vector<OptionOfMethods> all;
  for (const TrainingMethodInfo* method : training_methods())
    for (const MethodOption* option : method->options) {
      auto found = std::ranges::find(all, option, &OptionOfMethods::option);
      if (found == all.end()) found = all.insert(all.end(), {option, {}});
      found->methods.push_back(method);
    }
  return all;
}

std::string names_of(const std::vector<const TrainingMethodInfo*>& methods,
                     std::string_view separator) {
  std::string text;
  for (const TrainingMethodInfo* method : methods)
    text += (text.empty() ? "" : std::string(separator)) + method->name;
  return text;
}

}  // namespace tureen
