#include "jobs/training/training_method.hpp"

#include <utility>

#include "base/error.hpp"
#include "jobs/training/methods.hpp"

namespace tureen {

namespace {

/// Throws UsageError if an option of the other method is given, or both --steps and --minutes.
void require_own_options(const TrainingOptions& options) {
  using Given = std::pair<bool, const char*>;
  const Given soup[] = {{options.preset.has_value(), "--preset"},
                        {options.published, "--compat"},
                        {options.triangles.has_value(), "--triangles"},
                        {options.batch.has_value(), "--batch"},
                        {options.level.has_value(), "--level"},
                        {options.device == trainer::Device::cuda, "--device cuda"}};
  const Given gaussians[] = {{options.max_splats.has_value(), "--max-splats"},
                             {options.minutes.has_value(), "--minutes"}};
  const auto refuse = [](auto& others, const char* method, const char* hint) {
    for (const auto& [given, name] : others)
      if (given) throw UsageError(std::string(name) + " needs --method " + method, hint);
  };
  if (options.method == TrainingMethodName::gaussians)
    refuse(soup, "diffsoup", "--max-splats limits the number of Gaussians");
  else
    refuse(gaussians, "gaussians", "--triangles sets the number of triangles of a soup");
  if (options.steps && options.minutes)
    throw UsageError("--steps and --minutes exclude each other",
                     "--minutes fits the number of steps to the time");
}

}  // namespace

std::unique_ptr<TrainingMethod> make_training_method(const TrainingOptions& options) {
  require_own_options(options);
  return options.method == TrainingMethodName::gaussians ? make_gaussian_method(options)
                                                         : make_diffsoup_method(options);
}

}  // namespace tureen
