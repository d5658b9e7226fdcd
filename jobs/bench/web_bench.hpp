// Converts a download of the browser's bench.html to results of `tureen bench`, with the same
// statistics. docs/json.md explains the keys.
#pragma once

#include <vector>

#include "base/input.hpp"
#include "jobs/bench/bench_json.hpp"

namespace tureen::results {

/// Version of the file's layout. Readers reject larger versions.
inline constexpr int web_bench_version = 1;

/// One result per scene of an untrusted file, at least one, in the order of the file. Browsers do
/// not report some values: the processor's model is the user agent, the memory is 0 MiB, and there
/// are no pass times. Ignores unknown keys. Throws InputError with the file and the path of a
/// missing, invalid or impossible member.
std::vector<BenchResult> read_web_bench(Input& input);

}  // namespace tureen::results
