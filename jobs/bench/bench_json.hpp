// The JSON file of `tureen bench`. docs/json.md explains the keys.
#pragma once

#include <string>

#include "base/json/json_text.hpp"
#include "base/json/json_view.hpp"
#include "jobs/bench/bench_result.hpp"

namespace tureen::results {

/// Version of the file's layout. Readers reject larger versions.
/// 2: p99 and low_1_percent_fps may be null, and some keys are optional.
inline constexpr int bench_result_version = 2;

// The origin of a result, as other results have it, too.
Json to_json(const BenchProgram& program);
Json to_json(const BenchScene& scene);
Json to_json(const Machine& machine);
Json to_json(const BenchDevice& device);
/// From untrusted files. Both throw InputError with the path of a missing or invalid member.
BenchScene scene_of(const JsonView& view);
BenchDevice device_of(const JsonView& view);

Json to_json(const BenchResult& result);

/// Reads the output of to_json() from an untrusted file; ignores unknown keys. Throws InputError
/// with `file` and the path of a missing or invalid member.
BenchResult bench_result_from_json(const std::string& text, const std::string& file);

}  // namespace tureen::results
