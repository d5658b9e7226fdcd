// How much memory a call takes at most: operator new and delete of the whole program, counted.
// Linked into a test program of its own (memory_meter.cpp replaces them).
#pragma once

#include <cstddef>

namespace tureen::test {

/// The most of them since it was made, beyond those of then.
class MemoryMeter {
 public:
  MemoryMeter();
  std::size_t peak() const;

 private:
  std::size_t before_;
};

}  // namespace tureen::test
