// Peak memory of a call: operator new and delete of the whole program are counted. Link it into a
// separate test program, because memory_meter.cpp replaces them.
#pragma once

#include <cstddef>

namespace tureen::test {

/// The peak since its construction, minus the memory in use at its construction.
class MemoryMeter {
 public:
  MemoryMeter();
  std::size_t peak() const;

 private:
  std::size_t before_;
};

}  // namespace tureen::test
