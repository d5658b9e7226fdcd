// The result of growth_benchmark on a page.
#pragma once

#include <string>
#include <vector>

#include "bench/page/section.hpp"

namespace tureen::test {

/// Times, fits with their standard errors, and what growth_benchmark says of them.
Section growth_section(const Measurements& measurements, const std::string& name);

}  // namespace tureen::test
