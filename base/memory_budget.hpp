// A limit on the memory that reading may allocate. Files are untrusted, and a few bytes can request
// gigabytes: by a false count, or by an image or archive that decompresses to 1000 times its size.
// Readers therefore count every allocation before they make it.
//
// Counted are allocations whose size depends on the file: arrays, texts, images and temporary
// memory of decoders. The fixed buffers of readers, a few kilobytes, are not counted.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace tureen {

/// 4 GiB: enough for the largest published MobileNeRF scenes (16 shapes, two images of 4096 x 4096
/// each), and the maximum memory of 32-bit WebAssembly.
inline constexpr std::uint64_t default_max_memory = std::uint64_t(4) << 30;

/// The limit for each read from now on, in bytes. It is global, since memory belongs to the
/// process: a program sets it once before it reads, and it then applies to every reader.
void set_max_memory(std::uint64_t bytes);
std::uint64_t max_memory();

/// The hint in every error about this limit.
inline constexpr const char* max_memory_hint = "raise the limit with --max-memory";

/// Whether the error reports this limit.
inline bool is_about_memory(const Error& error) {
  return error.hint().starts_with(max_memory_hint);
}

/// Parses "512MiB", "4 GB", "1.5g" or a number of bytes. Units are powers of 1024, with or without
/// the "i". Throws UsageError for any other text, below 1 byte and above 2^62 bytes.
std::uint64_t parse_memory_size(const std::string& text);

/// The inverse, to four digits: "4 GiB", "1.5 MiB", "17 bytes".
std::string memory_size_text(std::uint64_t bytes);

/// Counts the memory that one read operation may still allocate, over all files that it opens.
/// Copies share one count. Not thread-safe.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t limit = max_memory());

  std::uint64_t limit() const { return count_->limit; }
  std::uint64_t taken() const { return count_->taken; }
  std::uint64_t left() const { return limit() - taken(); }

  /// Counts `elements` of `each` bytes. Returns false and counts nothing if they exceed the limit.
  [[nodiscard]] bool take(std::uint64_t elements, std::size_t each = 1);
  /// Subtracts `bytes`, at most taken(), from the count.
  void give_back(std::uint64_t bytes);

  /// The reason for the error about `what`; its hint is max_memory_hint.
  std::string refusal(const std::string& what) const;

 private:
  struct Count {
    std::uint64_t limit, taken;
  };
  std::shared_ptr<Count> count_;
};

/// Temporary memory: the destructor gives back everything taken during its lifetime, except the
/// kept bytes.
class PassingMemory {
 public:
  explicit PassingMemory(MemoryBudget budget)
      : budget_(std::move(budget)), before_(budget_.taken()) {}
  PassingMemory(const PassingMemory&) = delete;
  PassingMemory& operator=(const PassingMemory&) = delete;
  ~PassingMemory() {
    const std::uint64_t stays = before_ + kept_;
    if (budget_.taken() > stays) budget_.give_back(budget_.taken() - stays);
  }

  /// Marks `bytes` of the taken bytes as kept.
  void keep(std::uint64_t bytes) { kept_ += bytes; }

 private:
  MemoryBudget budget_;
  std::uint64_t before_, kept_ = 0;
};

/// Reserves capacity for `more` elements: at least twice the old size if the budget allows it, else
/// the exact size. Returns false and changes nothing if that exceeds the budget too. The old and
/// the new memory are both counted until the copy is done.
template <class T>
[[nodiscard]] bool make_room(std::vector<T>& values, std::uint64_t more, MemoryBudget& budget) {
  if (more <= values.capacity() - values.size()) return true;
  if (more > values.max_size() - values.size()) return false;
  const auto total = values.size() + static_cast<std::size_t>(more);
  const std::size_t wanted = std::max(total, std::min(2 * values.size(), values.max_size()));
  std::size_t room = wanted;
  if (!budget.take(room, sizeof(T))) {
    room = total;
    if (room == wanted || !budget.take(room, sizeof(T))) return false;
  }
  const std::size_t before = values.capacity();
  values.reserve(room);
  budget.give_back(std::uint64_t(before) * sizeof(T));
  return true;
}

}  // namespace tureen
