#include "jobs/training/methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/decimal_text.hpp"
#include "base/json/json_file.hpp"

namespace tureen {

std::span<const TrainingMethodInfo* const> training_methods() {
  static constexpr const TrainingMethodInfo* methods[] = {
      &diffsoup_method,
      &gaussians_method,
      &triangles_method,
  };
  return methods;
}

std::string describe_views(const Dataset& dataset) {
  const Camera& first = dataset.train.front().camera;
  return fmt::format("{} and {}, the first {} x {}", counted(dataset.train.size(), "training view"),
                     counted(dataset.test.size(), "test view"), first.width, first.height);
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

void require_checkpoint_of(const TrainingMethodInfo& method, const std::filesystem::path& file) {
  Input input = Input::open(file);
  trainer::CheckpointMagic magic{};
  if (input.read_some(std::as_writable_bytes(std::span(magic))) < magic.size()) return;
  for (const TrainingMethodInfo* other : training_methods())
    if (other != &method && magic == other->magic)
      throw InputError({input.name(), {}, {}},
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
