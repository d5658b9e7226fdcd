#include "jobs/training/training_method.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace tureen {

std::unique_ptr<TrainingMethod> make_training_method(const TrainingOptions& options) {
  for (const auto& [option, methods] : all_method_options()) {
    const OptionValue& value = options[*option];
    if (!value.is_given() || std::ranges::find(methods, options.method) != methods.end() ||
        std::ranges::find(option->everywhere, value.text) != option->everywhere.end())
      continue;
    // "--preset", but "--device cuda".
    throw UsageError("--" + std::string(option->name) +
                         (option->everywhere.empty() ? "" : " " + value.text) + " needs --method " +
                         names_of(methods, " or "),
                     option->instead);
  }
  return options.method->make(options);
}

}  // namespace tureen
