// All that was measured, as sections for the pages of docs/.
#pragma once

#include <string>
#include <vector>

#include "bench/page/section.hpp"

namespace tureen::test {

struct Sections {
  std::vector<Section> made;
  std::vector<std::string>
      failures;  // "NAME: what its result lacks"; the others are not lost by it
};

/// A section for each measurement that has tables of its own, and one for each kind that stands in
/// one table.
Sections sections_of(const Measurements& measurements);

}  // namespace tureen::test
