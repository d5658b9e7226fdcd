// Sets the memory limit of readers for the duration of a test.
#pragma once

#include <cstdint>

#include "base/memory_budget.hpp"

namespace tureen::test {

class MemoryLimit {
 public:
  explicit MemoryLimit(std::uint64_t bytes) { set_max_memory(bytes); }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;
  ~MemoryLimit() { set_max_memory(before_); }

 private:
  const std::uint64_t before_ = max_memory();
};

}  // namespace tureen::test
