// The background of photographs that show an object before one colour, such as a white backdrop,
// and have no alpha.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "scene/photographs.hpp"

namespace tureen::trainer {

/// The colour, in [0, 1], that the borders of the photographs to train on have almost everywhere.
/// Nullopt if there is none, as in photographs of a place. Alpha and masks are ignored.
std::optional<glm::vec3> plain_background(const Dataset& dataset);

}  // namespace tureen::trainer
