// All that was measured, as sections for the pages of docs/.
#pragma once

#include <vector>

#include "bench/page/section.hpp"

namespace tureen::test {

/// A section for each measurement that has tables of its own, and one for each kind that stands in
/// one table. Throws InputError with the name of the section whose result lacks something.
std::vector<Section> sections_of(const Measurements& measurements);

}  // namespace tureen::test
