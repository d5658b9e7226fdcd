// Soups that have, or plainly lack, what lets a plan leave something out: one trait for each entry
// of runtime/plan/specialisation.hpp. Tests prove with them that nothing changes, benchmarks what
// it gains.
#pragma once

#include "runtime/plan/specialisation.hpp"
#include "scene/triangle_soup.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen::test {

/// The appearance that a soup must have to be given this trait.
Kind kind_of_trait(Specialisation what);

/// Changes a soup of that kind, with texels of 8 bits where it has any, so that `what` can be left
/// out of it. Geometry stays; the appearance, its size included, may not.
void give_trait(Specialisation what, TriangleSoup& soup);

/// A soup of that kind of which `what` cannot be left out.
TriangleSoup soup_without_trait(Specialisation what, std::uint64_t seed);

}  // namespace tureen::test
