// The lattice level of a run whose configuration leaves it open.
#pragma once

#include "scene/photographs.hpp"
#include "trainer/diffsoup/config.hpp"

namespace tureen::trainer {

/// The level, 3 to highest_automatic_level, with about 3.5 texels for each pixel that a triangle
/// covers. A photograph's covered pixels are those with an alpha of one half and more, without the
/// ignored ones, in the mean over dataset.train. Half of the triangles share them, because others
/// are in front of the rest.
int fitting_level(const Dataset& dataset, int triangles);

/// The configuration with that level, if max_level is automatic_level.
Config with_fitting_level(const Config& config, const Dataset& dataset);

}  // namespace tureen::trainer
