// How much memory reading may take. Files are untrusted, and a few bytes of them can ask for
// gigabytes: by a count that is false, or by a picture or an archive that unfolds to a thousand
// times its size. So readers count what they are about to allocate, before they do.
//
// What is counted is what a reader asks for by what a file says: arrays, texts, pictures, what
// decoders hold meanwhile. The few kilobytes of buffers that every reader has are not.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tureen {

/// 4 GiB: more than twice what the largest published MobileNeRF scenes take (16 shapes, two images
/// of 4096 x 4096 each), and what a 32-bit browser could hold at most.
inline constexpr std::uint64_t default_max_memory = std::uint64_t(4) << 30;

/// What one read may take from now on, in bytes. Memory is the process's, and so is this: a program
/// sets it once, before it reads, and no reader can be forgotten.
void set_max_memory(std::uint64_t bytes);
std::uint64_t max_memory();

/// The hint of every error about this limit.
inline constexpr const char* max_memory_hint = "--max-memory changes that";

/// "512MB", "4 GB", "1.5GB" or a number of bytes, with kB, MB, GB and TB powers of 1024. Throws
/// UsageError for anything else, for nothing and for more than a file can have.
std::uint64_t parse_memory_size(const std::string& text);

/// The same the other way round: "4 GB", "1.5 MB", "17 bytes".
std::string memory_size_text(std::uint64_t bytes);

/// What one read has left, over all the files that it opens: copies count together. Not for several
/// threads at a time.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t limit = max_memory());

  std::uint64_t limit() const { return count_->limit; }
  std::uint64_t taken() const { return count_->taken; }
  std::uint64_t left() const { return limit() - taken(); }

  /// Counts so many elements of `each` bytes; false, and nothing counted, where they are too many.
  [[nodiscard]] bool take(std::uint64_t elements, std::size_t each = 1);
  /// No more than was taken.
  void give_back(std::uint64_t bytes);

  /// The reason for the error about `what`; its hint is max_memory_hint.
  std::string refusal(const std::string& what) const;

 private:
  struct Count {
    std::uint64_t limit, taken;
  };
  std::shared_ptr<Count> count_;
};

/// While it lives, what is taken is meant to pass: at its end all of that is given back, but for
/// what was kept.
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

  /// So many of the bytes taken stay.
  void keep(std::uint64_t bytes) { kept_ += bytes; }

 private:
  MemoryBudget budget_;
  std::uint64_t before_, kept_ = 0;
};

/// Room for `more` elements, as vectors make it: exactly that for a first, large part, and in
/// strides that double where many small ones follow each other. False, and nothing changed, where
/// that is too much; meanwhile both the old and the new room are counted.
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
