// How a run read its photographs, as the first line of its log stores it: a run that resumes needs
// nothing but its output.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "formats/dataset/dataset.hpp"

namespace tureen {

struct RunInput {
  std::string dataset;     // as given
  DatasetOptions options;  // without `part` and `progress`
};

/// A JSON object, for RunPlan::input. A relative path of the dataset is stored relative to the
/// folder of `log`.
std::string to_json(const RunInput& input, const std::filesystem::path& log);

/// The input of a log; nullopt if there is no log, or its first line has no input. Throws
/// InputError if that is damaged.
std::optional<RunInput> input_of_log(const std::filesystem::path& log);

}  // namespace tureen
