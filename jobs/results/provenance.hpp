// What every result says of where it comes from: the program, the scene, the machine and the
// device, as JSON. docs/json.md explains the keys.
// Include it in sources only.
#pragma once

#include "base/json/json_view.hpp"
#include "jobs/results/bench_json.hpp"

namespace tureen::results {

Json to_json(const BenchProgram& program);
Json to_json(const BenchScene& scene);
Json to_json(const Machine& machine);
Json to_json(const BenchDevice& device);

// Untrusted: each throws InputError with the path of what is missing or of another kind. Keys that
// are not known are passed over.
BenchProgram program_of(const JsonView& view);
BenchScene scene_of(const JsonView& view);
Machine machine_of(const JsonView& view);
BenchDevice device_of(const JsonView& view);

}  // namespace tureen::results
