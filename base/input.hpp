// Untrusted bytes from a file or a block of memory, read in order. Every failure names the place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/error.hpp"
#include "base/memory_budget.hpp"

namespace tureen {

class Input {
 public:
  /// Throws InputError if the file cannot be opened or is not a regular file. A reader of several
  /// files passes the budget of the first one to the others.
  static Input open(const std::filesystem::path& path, MemoryBudget budget = MemoryBudget());
  /// The bytes must outlive the Input. Error messages print `name` as the file.
  static Input memory(std::string name, std::span<const std::byte> bytes,
                      MemoryBudget budget = MemoryBudget());

  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }
  std::uint64_t position() const { return position_; }
  std::uint64_t remaining() const { return size_ - position_; }

  const MemoryBudget& budget() const { return budget_; }
  /// Takes `elements` * `each` bytes from the budget; call it before the allocation. Throws
  /// InputError if they exceed the rest of the budget.
  void take_memory(std::uint64_t elements, std::size_t each, const char* what) {
    if (!budget_.take(elements, each)) fail(budget_.refusal(what), max_memory_hint);
  }
  /// Calls make_room (base/memory_budget.hpp); throws InputError if it fails.
  template <class T>
  void make_room_in(std::vector<T>& values, std::uint64_t more, const char* what) {
    if (!make_room(values, more, budget_)) fail(budget_.refusal(what), max_memory_hint);
  }

  /// Throws InputError if `position` lies past the end.
  void seek(std::uint64_t position);

  /// Reads up to buffer.size() bytes and returns their number; 0 at the end.
  std::size_t read_some(std::span<std::byte> buffer);

  /// Fills all of `buffer`, or throws an InputError: `what` is truncated.
  void read(std::span<std::byte> buffer, const char* what);

  template <class T>
  T read_value(const char* what) {
    static_assert(std::is_trivially_copyable_v<T>);
    T value;
    read(std::as_writable_bytes(std::span(&value, 1)), what);
    return value;
  }

  /// `count` values. The count is checked against the remaining bytes and the budget before any
  /// allocation.
  template <class T>
  std::vector<T> read_values(std::uint64_t count, const char* what) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (count > remaining() / sizeof(T)) fail_truncated(count, sizeof(T), what);
    take_memory(count, sizeof(T), what);
    std::vector<T> values(static_cast<std::size_t>(count));
    read(std::as_writable_bytes(std::span(values)), what);
    return values;
  }

  /// All bytes from the current position on.
  std::vector<std::byte> read_rest();
  std::string read_text();

  /// Throws an InputError at the current position, or at `byte`.
  [[noreturn]] void fail(const std::string& reason, const std::string& hint = {}) const;
  [[noreturn]] void fail_at(std::uint64_t byte, const std::string& reason,
                            const std::string& hint = {}) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  Input(std::string name, MemoryBudget budget)
      : name_(std::move(name)), budget_(std::move(budget)) {}
  [[noreturn]] void fail_truncated(std::uint64_t count, std::size_t each, const char* what) const;

  std::string name_;
  MemoryBudget budget_;
  std::unique_ptr<std::FILE, Close> file_;  // empty for memory
  std::span<const std::byte> bytes_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
};

}  // namespace tureen
