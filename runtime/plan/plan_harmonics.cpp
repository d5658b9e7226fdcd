// The harmonics' part of a plan: the bands with a visible effect.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/plan/plan_draft.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

/// Entry l: upper bound of the change of a channel by bands l and above, over all elements. |sum_m
/// Y_lm(d) c_m| <= sqrt((2l+1) / 4 pi) |c_l| for every direction (Cauchy-Schwarz and the addition
/// theorem).
std::vector<double> largest_from_band(const Harmonics& sh) {
  const auto count = std::size_t(harmonics::count(sh.degree));
  std::vector<double> largest(std::size_t(sh.degree) + 1, 0.0);
  for (std::size_t first = 0; first < sh.coefficients.size(); first += count) {
    glm::dvec3 above(0.0);
    for (int l = sh.degree; l > 0; --l) {
      glm::dvec3 energy(0.0);
      for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
        const glm::dvec3 c = sh.coefficients[first + std::size_t(i)];
        energy += c * c;
      }
      above += std::sqrt((2 * l + 1) / (4 * std::numbers::pi)) * glm::sqrt(energy);
      largest[std::size_t(l)] = std::max({largest[std::size_t(l)], above.x, above.y, above.z});
    }
  }
  return largest;
}

}  // namespace

void plan_appearance(PlanDraft& draft, const Harmonics& sh) {
  int& degree = draft.plan.harmonics_degree;
  degree = sh.degree;
  if (!draft.may(Specialisation::harmonics_bands)) return;
  const std::vector<double> largest = largest_from_band(sh);
  while (degree > 0 && largest[std::size_t(degree)] < half_step) --degree;
  if (degree < sh.degree)
    draft.apply({Specialisation::harmonics_bands, std::size_t(sh.degree - degree),
                 std::size_t(sh.degree), steps_of(largest[std::size_t(degree) + 1])});
}

}  // namespace tureen
