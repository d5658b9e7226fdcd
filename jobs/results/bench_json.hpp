// The JSON file of `tureen bench`. docs/json.md explains the keys.
#pragma once

#include <string>

#include "jobs/bench/bench_result.hpp"
#include "jobs/results/json_text.hpp"

namespace tureen::results {

/// Of the file's layout. A reader refuses a larger one.
/// 2: p99 and low_1_percent_fps may be null, and there are keys that not every file has.
inline constexpr int bench_result_version = 2;

Json to_json(const BenchResult& result);

/// Reads what to_json wrote; keys that are not known are passed over. Throws InputError with `file`
/// and the path of what is missing or of another kind: untrusted.
BenchResult bench_result_from_json(const std::string& text, const std::string& file);

}  // namespace tureen::results
