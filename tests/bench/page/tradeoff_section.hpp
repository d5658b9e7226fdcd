// Results of `tureen tradeoff` on a page: of a scene, and joined over several.
#pragma once

#include <string>
#include <vector>

#include "bench/page/section.hpp"

namespace tureen::test {

/// The choice; every knob alone, and all that is on a front; E_model in a table of its own.
Section tradeoff_section(const Measurements& measurements, const std::string& name);

Section scenes_section(const Measurements& measurements, const std::string& name);

}  // namespace tureen::test
