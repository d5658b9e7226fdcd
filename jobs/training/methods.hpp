// The methods of make_training_method(), and the checks that they share.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "jobs/training/training_method.hpp"
#include "trainer/common/initialisation.hpp"
#include "trainer/common/view_fingerprint.hpp"

namespace tureen {

/// "100 training views and 25 test views, the first 400 x 400". Needs a training view.
std::string describe_views(const Dataset& dataset);

/// Throws UsageError if the first primitives should be those of a scene, but the options name none.
void require_scene(trainer::Initialisation initialisation, const TrainingOptions& options);

/// Throws UsageError if a checkpoint is of other training views, `stored`.
void require_same_views(const Dataset& dataset,
                        const std::vector<trainer::ViewFingerprint>& stored);

std::unique_ptr<TrainingMethod> make_diffsoup_method(const TrainingOptions& options);
std::unique_ptr<TrainingMethod> make_gaussian_method(const TrainingOptions& options);
std::unique_ptr<TrainingMethod> make_window_method(const TrainingOptions& options);

}  // namespace tureen
