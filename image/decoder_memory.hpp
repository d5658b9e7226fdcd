// The memory of stb_image, a decoder written in C: counted, limited and initialised to zero.
//
// The limit is needed because a few bytes of deflated data can make stb request gigabytes for an
// image of any size. Zeros are needed because the JPEG decoder reads tables that a damaged file has
// not defined.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/memory_budget.hpp"

namespace tureen::decoder_memory {

/// During its lifetime the functions below allocate for this thread: at most the rest of `budget`,
/// and at most `limit` at a time. The caller releases all of it before the destructor.
class Scope {
 public:
  Scope(MemoryBudget budget, std::uint64_t limit);
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;
  ~Scope();

  /// Whether an allocation failed, and which of the two limits caused it.
  bool beyond_budget() const { return beyond_budget_; }
  bool beyond_limit() const { return beyond_limit_; }

 private:
  friend void* allocate(std::size_t size);
  friend void* reallocate(void* old, std::size_t size);
  friend void release(void* old);
  bool take(std::size_t size);
  void give_back(std::size_t size);

  MemoryBudget budget_;
  std::uint64_t limit_, held_ = 0;
  bool beyond_budget_ = false, beyond_limit_ = false;
};

/// As calloc, realloc (added bytes are not zeroed) and free. Return null without a Scope or beyond
/// its limits.
void* allocate(std::size_t size);
void* reallocate(void* old, std::size_t size);
void release(void* old);

}  // namespace tureen::decoder_memory
