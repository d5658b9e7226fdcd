#include "jobs/training/methods.hpp"

#include <fmt/format.h>

#include "base/decimal_text.hpp"
#include "base/error.hpp"

namespace tureen {

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

}  // namespace tureen
