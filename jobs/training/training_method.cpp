#include "jobs/training/training_method.hpp"

#include <utility>

#include "base/error.hpp"
#include "jobs/training/methods.hpp"

namespace tureen {

namespace {

/// Throws UsageError if an option of another method is given, or both --steps and --minutes.
void require_own_options(const TrainingOptions& options) {
  using Given = std::pair<bool, const char*>;
  const Given soup[] = {{options.preset.has_value(), "--preset"},
                        {options.published, "--compat"},
                        {options.triangles.has_value(), "--triangles"},
                        {options.batch.has_value(), "--batch"},
                        {options.level.has_value(), "--level"},
                        {options.device == trainer::Device::cuda, "--device cuda"}};
  const Given splats[] = {{options.max_splats.has_value(), "--max-splats"},
                          {options.minutes.has_value(), "--minutes"}};
  const Given triangles[] = {{options.opaque, "--opaque"}};
  const auto refuse = [](auto& others, const char* methods, const char* hint) {
    for (const auto& [given, name] : others)
      if (given) throw UsageError(std::string(name) + " needs --method " + methods, hint);
  };
  const bool is_soup = options.method == TrainingMethodName::diffsoup;
  if (options.method != TrainingMethodName::triangles)
    refuse(triangles, "triangles",
           is_soup ? "the triangles of a soup are always opaque" : "Gaussians stay soft");
  if (is_soup)
    refuse(splats, "gaussians or triangles", "--triangles sets the number of triangles of a soup");
  else
    refuse(soup, "diffsoup", "--max-splats limits the number of splats");
  if (options.steps && options.minutes)
    throw UsageError("--steps and --minutes exclude each other",
                     "--minutes fits the number of steps to the time");
}

}  // namespace

std::unique_ptr<TrainingMethod> make_training_method(const TrainingOptions& options) {
  require_own_options(options);
  switch (options.method) {
    case TrainingMethodName::gaussians:
      return make_gaussian_method(options);
    case TrainingMethodName::triangles:
      return make_window_method(options);
    case TrainingMethodName::diffsoup:
      break;
  }
  return make_diffsoup_method(options);
}

}  // namespace tureen
