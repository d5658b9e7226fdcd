// Results of `tureen bench` on a page.
#pragma once

#include <string>
#include <vector>

#include "bench/page/section.hpp"

namespace tureen::test {

/// A row a set of cameras and size: times of the first configuration, and of the others against it.
Section bench_section(const Measurements& measurements, const std::string& name);

/// The shading pass as a fragment and as a compute shader, all scenes in one table.
Section stages_section(const Measurements& measurements, const std::vector<std::string>& names);

}  // namespace tureen::test
