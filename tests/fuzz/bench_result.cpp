// A result of `tureen bench`, as --against reads it.
#include "jobs/bench/bench_json.hpp"
#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void bench_result(Bytes bytes) {
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  results::to_json(results::bench_result_from_json(text, "fuzz.json"));
}

}  // namespace tureen::fuzz
