// The origin of a result as JSON: the program, the scene, the machine and the device. docs/json.md
// explains the keys. Include it only in source files.
#pragma once

#include "base/json/json_view.hpp"
#include "jobs/bench/bench_json.hpp"

namespace tureen::results {

Json to_json(const BenchProgram& program);
Json to_json(const BenchScene& scene);
Json to_json(const Machine& machine);
Json to_json(const BenchDevice& device);

// For untrusted files. Each function throws InputError with the path of a missing or invalid
// member, and ignores unknown keys.
BenchProgram program_of(const JsonView& view);
BenchScene scene_of(const JsonView& view);
Machine machine_of(const JsonView& view);
BenchDevice device_of(const JsonView& view);

}  // namespace tureen::results
