#include "jobs/training/methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/json/json_file.hpp"

namespace tureen {

std::span<const TrainingMethodInfo* const> training_methods() {
  static constexpr const TrainingMethodInfo* methods[] = {
      &diffsoup_method,
      &gaussians_method,
      &triangles_method,
      &neural_method,
  };
  return methods;
}

const MethodOption minutes_option{
    .name = "minutes",
    .type = MethodOption::Type::number,
    .help =
        "minutes for the training, more than 0: they determine the number of steps and, unless it "
        "is given, the size of the photographs",
    .instead = "--steps sets the length of the training",
    .value_name = "N",
    .is_common = true};

void set_time(double& minutes, const TrainingOptions& options) {
  const auto& given = options[minutes_option].number;
  if (options.steps && given)
    throw UsageError("--steps and --minutes exclude each other",
                     "use one: --minutes chooses the number of steps");
  // In a file, 0 means a fixed number of steps; on the command line, --steps does.
  if (given && !(*given > 0))
    throw UsageError("--minutes: " + trainer::double_text(*given) +
                         " is out of range; the time must be more than 0",
                     "--steps sets a fixed number of steps");
  if (options.steps) minutes = 0;
  if (given) minutes = *given;
}

OwnFact replaced_minutes(double minutes) {
  return {"replaced_minutes", minutes,
          fmt::format("--steps replaces the {} min of the constants", minutes)};
}

void require_scene(trainer::Initialisation initialisation, const TrainingOptions& options) {
  if (initialisation == trainer::Initialisation::mesh && options.mesh().empty())
    throw UsageError("initialisation \"mesh\" needs a scene", "name its file with --init FILE");
}

void require_same_views(const Dataset& dataset,
                        const std::vector<trainer::ViewFingerprint>& stored) {
  if (const auto reason = difference(trainer::fingerprint(dataset.train), stored))
    throw UsageError("--resume needs the dataset of the checkpoint: " + *reason);
}

const TrainingMethodInfo* method_of_checkpoint(const std::filesystem::path& file) {
  trainer::CheckpointMagic magic{};
  try {
    Input input = Input::open(file);
    input.read_some(std::as_writable_bytes(std::span(magic)));
  } catch (const InputError&) {
    return nullptr;
  }
  for (const TrainingMethodInfo* method : training_methods())
    if (magic == method->magic) return method;
  return nullptr;
}

void require_checkpoint_of(const TrainingMethodInfo& method, const std::filesystem::path& file) {
  const TrainingMethodInfo* other = method_of_checkpoint(file);
  if (other && other != &method)
    throw InputError({file.string(), {}, {}},
                     std::string("this is a checkpoint of --method ") + other->name,
                     std::string("continue it with --method ") + other->name);
}

void refuse_constants_of_others(const TrainingOptions& options) {
  nlohmann::json document;
  try {
    Input input = Input::open(options.file);
    document = read_json(input);
  } catch (const InputError&) {  // the caller has an error about the same file
    return;
  }
  if (!document.is_object()) return;
  const auto has_all = [&](const TrainingMethodInfo& method) {
    const std::vector<std::string> names = method.constants();
    return std::ranges::all_of(document.items(), [&](const auto& item) {
      return std::ranges::find(names, item.key()) != names.end();
    });
  };
  const std::string own = options.method->name;
  if (has_all(*options.method)) return;
  for (const TrainingMethodInfo* other : training_methods())
    if (has_all(*other)) {
      const std::string name = other->name;
      throw InputError({options.file, {}, {}}, "these are constants of --method " + name,
                       "use --method " + name + ", or list the constants with --method " + own +
                           " --list-config");
    }
}

void set_initialisation(trainer::Initialisation& initialisation, const TrainingOptions& options) {
  if (options.begin == "random")
    initialisation = trainer::Initialisation::random;
  else if (options.begin == "points")
    initialisation = trainer::Initialisation::points;
  else if (!options.begin.empty())
    initialisation = trainer::Initialisation::mesh;
}

}  // namespace tureen
