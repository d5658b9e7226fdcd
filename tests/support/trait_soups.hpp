// Soups with or clearly without the traits that specialisations of soups need: one trait for each
// (runtime/plan/specialisation.hpp). Tests prove with them that a specialisation changes no image,
// and benchmarks measure its gain.
#pragma once

#include <vector>

#include "runtime/plan/specialisation.hpp"
#include "scene/triangle_soup.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen::test {

/// Those that soups can have.
std::vector<SpecialisationName> specialisations_of_soups();

/// The appearance that a soup needs for this trait.
Kind kind_of_trait(Specialisation what);

/// Changes a soup of that kind so that the specialisation `what` applies. Lattice texels must have
/// 8 bits. The geometry stays; the appearance and its size may change.
void give_trait(Specialisation what, TriangleSoup& soup);

/// A soup of that kind without the trait, so that `what` does not apply.
TriangleSoup soup_without_trait(Specialisation what, std::uint64_t seed);

}  // namespace tureen::test
