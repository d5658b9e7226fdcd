// Results of `tureen bench` on a page.
#pragma once

#include <string>
#include <vector>

#include "bench/page/section.hpp"

namespace tureen::test {

/// A row a set of cameras and size: rounds, frames and times of the first configuration, and the
/// others against it. What is not known, or had not come to rest, is marked.
Section bench_section(const Measurements& measurements, const std::string& name);

/// The shading pass as a fragment and as a compute shader, all scenes in one table.
Section stages_section(const Measurements& measurements, const std::vector<std::string>& names);

/// Frames against the device's ceilings and the published pipeline, all scenes in one table.
Section gpu_section(const Measurements& measurements, const std::vector<std::string>& names);

}  // namespace tureen::test
