// What the browser's bench.html downloads, as results of `tureen bench`: the page measures, and the
// same statistics judge what it measured. docs/json.md explains the keys.
#pragma once

#include <string>
#include <vector>

#include "base/input.hpp"
#include "jobs/results/bench_json.hpp"

namespace tureen::results {

/// Of the file's layout. A reader refuses a larger one.
inline constexpr int web_bench_version = 1;

/// A result a scene of the file, at least one, in its order. What a browser does not tell stands as
/// it can: the user agent for the processor's model, 0 MiB of memory, no times of passes. Keys that
/// are not known are passed over. Throws InputError with the file and the path of what is missing,
/// of another kind or impossible: untrusted.
std::vector<BenchResult> read_web_bench(Input& input);

}  // namespace tureen::results
