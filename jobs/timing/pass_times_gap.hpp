// Why a result has no times of passes, or only some.
#pragma once

#include <optional>
#include <string_view>

namespace tureen {

/// Why times of passes are missing, or cover only a part of the frame.
enum class PassTimesGap {
  none,
  one_pass,            // the frame is a single pass
  no_timers,           // the device has no timers, or unreliable ones (gl::timers_mislead)
  disturbed_clock,     // the device reported a disturbance in every attempt
  exceeds_wall_clock,  // the sum is 0 or exceeds the wall clock
  partial,             // the passes are less than half of the frame
  other,               // of a result file without this field
};

/// "none", "one_pass", ..; as written to JSON.
std::string_view name_of(PassTimesGap gap);
std::optional<PassTimesGap> pass_times_gap(std::string_view name);

}  // namespace tureen
