#include "jobs/bench/bench_result.hpp"

namespace tureen {

const BenchConfiguration* find_configuration(const BenchResult& result, const std::string& name) {
  for (const BenchConfiguration& each : result.configurations)
    if (each.name == name) return &each;
  return nullptr;
}

}  // namespace tureen
