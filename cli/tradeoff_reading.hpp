// The result of a run of `tureen tradeoff`, read back: docs/json.md explains its keys.
#pragma once

#include "cli/tradeoff_report.hpp"
#include "formats/input.hpp"

namespace tureen::cli {

/// What to_json() of the report wrote. Of a setting its value is known, but neither its words nor
/// what it does to a preset: Setting::words is the value, Setting::apply and Outcome::preset are
/// empty. Of times FrameStatistics::mean, p99 and low_1_percent_fps are 0. Keys that are not known
/// are passed over.
///
/// Untrusted. Throws InputError with the file and the path of what is missing, of another kind,
/// beyond what can be measured, or in contradiction to the rest: an outcome of no knob's setting,
/// two of the same configuration, a panel that does not begin with the defaults, a front that is
/// not the configurations' own. At most 16 MiB (formats/json_file.hpp), 20,000 configurations a
/// panel, 64 knobs of 64 settings.
TradeoffReport read_tradeoff(Input& input);

}  // namespace tureen::cli
