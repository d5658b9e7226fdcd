#include "jobs/timing/pass_times_gap.hpp"

#include <algorithm>
#include <array>

namespace tureen {

namespace {

constexpr std::array<std::string_view, 7> gap_names{
    "none", "one_pass", "no_timers", "disturbed_clock", "exceeds_wall_clock", "partial", "other"};

}  // namespace

std::string_view name_of(PassTimesGap gap) { return gap_names[std::size_t(gap)]; }

std::optional<PassTimesGap> pass_times_gap(std::string_view name) {
  const auto found = std::find(gap_names.begin(), gap_names.end(), name);
  if (found == gap_names.end()) return {};
  return PassTimesGap(found - gap_names.begin());
}

}  // namespace tureen
