// Measurements by bench.html in a browser.
#include "jobs/bench/web_bench.hpp"

#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void web_bench(Bytes bytes) {
  Input input = Input::memory("fuzz.json", bytes);
  for (const BenchResult& result : results::read_web_bench(input)) results::to_json(result);
}

}  // namespace tureen::fuzz
