#include "jobs/training/training_method.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "jobs/training/methods.hpp"

namespace tureen {

namespace {

using Methods = std::vector<TrainingMethodName>;

/// An option that not every method has.
struct OwnOption {
  bool given;
  const char* name;
  Methods methods;      // that have it
  const char* instead;  // the hint for the other methods
};

std::vector<OwnOption> own_options(const TrainingOptions& options) {
  const Methods soups{TrainingMethodName::diffsoup}, gaussians{TrainingMethodName::gaussians},
      triangles{TrainingMethodName::triangles},
      splats{TrainingMethodName::gaussians, TrainingMethodName::triangles};
  return {
      {options.preset.has_value(), "--preset", soups,
       "this method chooses its constants by the alpha of the photographs; --config changes them"},
      {options.published, "--compat", soups, "--config sets the constants of this method"},
      {options.triangles.has_value(), "--triangles", soups,
       "--max-splats limits the number of splats"},
      {options.batch.has_value(), "--batch", soups,
       "a step of this method uses one photograph; --steps sets the number of steps"},
      {options.level.has_value(), "--level", soups,
       "splats have no textures; --max-splats sets how much detail they can show"},
      {options.device == trainer::Device::cuda, "--device cuda", soups,
       "this method trains on the processor, with --device cpu or auto"},
      {options.max_splats.has_value(), "--max-splats", splats,
       "--triangles sets the number of triangles"},
      {options.minutes.has_value(), "--minutes", splats, "--steps sets the length of the training"},
      {options.flat, "--flat", gaussians, "triangles are always flat"},
      {options.opaque, "--opaque", triangles,
       options.method == TrainingMethodName::diffsoup ? "the triangles of a soup are always opaque"
                                                      : "Gaussians stay soft"},
  };
}

/// "diffsoup", "diffsoup or gaussians".
std::string listed(const Methods& methods) {
  std::string text;
  for (const TrainingMethodName method : methods)
    text += (text.empty() ? "" : " or ") + std::string(name_of(method));
  return text;
}

/// Throws UsageError if an option of another method is given, or both --steps and --minutes.
void require_own_options(const TrainingOptions& options) {
  for (const OwnOption& option : own_options(options))
    if (option.given && std::ranges::find(option.methods, options.method) == option.methods.end())
      throw UsageError(std::string(option.name) + " needs --method " + listed(option.methods),
                       option.instead);
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
