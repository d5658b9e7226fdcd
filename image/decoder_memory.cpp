#include "image/decoder_memory.hpp"

#include <cassert>
#include <cstdlib>
#include <limits>

namespace tureen::decoder_memory {

namespace {

thread_local Scope* current = nullptr;

/// The size of the block after it, in bytes. The alignment keeps that of malloc.
struct alignas(std::max_align_t) Header {
  std::size_t size;
};

bool is_too_large(std::size_t size) {
  return size > std::numeric_limits<std::size_t>::max() - sizeof(Header);
}

Header* header_of(void* block) { return static_cast<Header*>(block) - 1; }

}  // namespace

Scope::Scope(MemoryBudget budget, std::uint64_t limit) : budget_(std::move(budget)), limit_(limit) {
  assert(!current);
  current = this;
}

Scope::~Scope() {
  assert(held_ == 0);
  current = nullptr;
}

bool Scope::take(std::size_t size) {
  if (beyond_limit_ || beyond_budget_) return false;
  if (size > limit_ - held_)
    beyond_limit_ = true;
  else if (!budget_.take(size))
    beyond_budget_ = true;
  else
    held_ += size;
  return !beyond_limit_ && !beyond_budget_;
}

void Scope::give_back(std::size_t size) {
  held_ -= size;
  budget_.give_back(size);
}

void* allocate(std::size_t size) {
  if (!current || is_too_large(size) || !current->take(size)) return nullptr;
  auto* header = static_cast<Header*>(std::calloc(1, sizeof(Header) + size));
  if (!header) {
    current->give_back(size);
    return nullptr;
  }
  header->size = size;
  return header + 1;
}

void* reallocate(void* old, std::size_t size) {
  if (!old) return allocate(size);
  const std::size_t before = header_of(old)->size;
  // Both blocks exist while realloc copies.
  if (!current || is_too_large(size) || !current->take(size)) return nullptr;
  auto* header = static_cast<Header*>(std::realloc(header_of(old), sizeof(Header) + size));
  current->give_back(header ? before : size);
  if (!header) return nullptr;
  header->size = size;
  return header + 1;
}

void release(void* old) {
  if (!old) return;
  if (current) current->give_back(header_of(old)->size);
  std::free(header_of(old));
}

}  // namespace tureen::decoder_memory
