// The memory of a decoder written in C, stb_image: counted, bounded, and zero at first.
//
// Bounded, because a few bytes of deflated data can make stb ask for gigabytes whatever the
// picture's size. Zero, because JPEG's decoder uses tables that a damaged file has never defined.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/memory_budget.hpp"

namespace tureen::decoder_memory {

/// While it lives, the functions below give this thread what `budget` has left, and no more than
/// `limit` at a time. All of it must be released before.
class Scope {
 public:
  Scope(MemoryBudget budget, std::uint64_t limit);
  Scope(const Scope&) = delete;
  Scope& operator=(const Scope&) = delete;
  ~Scope();

  /// Whether something was refused, by which of the two.
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

/// As calloc, realloc (what is new is not zero) and free; null where there is no Scope or it
/// refuses.
void* allocate(std::size_t size);
void* reallocate(void* old, std::size_t size);
void release(void* old);

}  // namespace tureen::decoder_memory
