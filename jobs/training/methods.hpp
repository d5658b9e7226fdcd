// The methods, and the checks that they share.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/input.hpp"
#include "jobs/training/training_method.hpp"
#include "trainer/common/config_table.hpp"
#include "trainer/common/initialisation.hpp"
#include "trainer/common/view_fingerprint.hpp"

namespace tureen {

extern const TrainingMethodInfo diffsoup_method, gaussians_method, triangles_method, neural_method;

/// The time of a run, which all methods fit their steps to.
extern const MethodOption minutes_option;

/// Sets the constant `minutes`: that of --minutes, or 0 with --steps. Throws UsageError for both.
void set_time(double& minutes, const TrainingOptions& options);

/// The note that --steps replaces the minutes of a file.
OwnFact replaced_minutes(double minutes);

/// Throws UsageError if the first primitives should be those of a scene, but the options name none.
void require_scene(trainer::Initialisation initialisation, const TrainingOptions& options);

/// Throws UsageError if a checkpoint is of other training views, `stored`.
void require_same_views(const Dataset& dataset,
                        const std::vector<trainer::ViewFingerprint>& stored);

/// Throws InputError with the right method if the file is a checkpoint of another one.
void require_checkpoint_of(const TrainingMethodInfo& method, const std::filesystem::path& file);

/// If the file of constants has those of another method, throws InputError with its name.
/// Otherwise returns.
void refuse_constants_of_others(const TrainingOptions& options);

/// The constants that `read` takes from the file of the options. Throws its InputError, or that the
/// file has the constants of another method.
template <class Read>
auto constants_of_file(const TrainingOptions& options, const Read& read) {
  try {
    return read(std::filesystem::path(options.file));
  } catch (const InputError&) {
    refuse_constants_of_others(options);
    throw;
  }
}

/// Sets `initialisation` if the options say where to begin.
void set_initialisation(trainer::Initialisation& initialisation, const TrainingOptions& options);

/// The names of constants, for TrainingMethodInfo.
template <class Fields>
std::vector<std::string> names_of_fields(Fields fields) {
  std::vector<std::string> names;
  for (const auto& field : fields) names.emplace_back(field.name);
  return names;
}

/// Sets `constant` to `value` if it is given. Throws UsageError for a value beyond the constant's
/// type; it is beyond the range of the field `name`, too.
template <class T, class Fields>
void set_whole(T& constant, const std::optional<std::int64_t>& value, std::string_view name,
               Fields fields) {
  if (!value) return;
  if (!std::in_range<T>(*value)) {
    for (const auto& field : fields)
      if (field.name == name)
        throw UsageError(std::string(name) + ": " +
                         field.range.refusal(double(*value), std::to_string(*value)));
  }
  constant = static_cast<T>(*value);
}

}  // namespace tureen
