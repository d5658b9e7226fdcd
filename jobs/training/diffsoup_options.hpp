// Options of the method diffsoup that other code uses.
#pragma once

#include "jobs/training/training_options.hpp"
#include "trainer/diffsoup/config.hpp"

namespace tureen {

/// The folder for DiffSoup's web viewer; the program that stores the scene also writes it.
extern const MethodOption export_option;

/// `base` with the single constants. `triangles` scales the initial number of triangles in
/// proportion. `level` also limits the other levels. Throws UsageError for invalid constants.
trainer::Config with_options(const trainer::Config& base, const TrainingOptions& options);

}  // namespace tureen
