// The methods of make_training_method().
#pragma once

#include <memory>
#include <string>

#include "jobs/training/training_method.hpp"

namespace tureen {

/// "100 training views and 25 test views, the first 400 x 400". Needs a training view.
std::string describe_views(const Dataset& dataset);

std::unique_ptr<TrainingMethod> make_diffsoup_method(const TrainingOptions& options);
std::unique_ptr<TrainingMethod> make_gaussian_method(const TrainingOptions& options);
std::unique_ptr<TrainingMethod> make_window_method(const TrainingOptions& options);

}  // namespace tureen
