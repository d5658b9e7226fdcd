// The background of photographs that show an object before one colour, such as a white backdrop,
// and have no alpha.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "scene/photographs.hpp"

namespace tureen::trainer {

/// The median colour, display-referred in [0, 1], of the border pixels of all photographs to train
/// on, if 95 % of these pixels are within 8/255 of it. Nullopt otherwise, as for photographs of a
/// place, and without photographs. Alpha and masks are ignored.
std::optional<glm::vec3> plain_background(const Dataset& dataset);

}  // namespace tureen::trainer
