// Reads the pickles of torch.save as data: nothing is imported, called or executed. Opcodes and
// globals must be on a list; any other is rejected with its name and byte.
//
// Opcodes (protocol 2, pickletools): PROTO STOP MARK; NONE NEWTRUE NEWFALSE; BININT BININT1
// BININT2 LONG1 BINFLOAT; BINUNICODE; EMPTY_LIST APPEND APPENDS; EMPTY_TUPLE TUPLE TUPLE1..3;
// EMPTY_DICT SETITEM SETITEMS; BINPUT LONG_BINPUT BINGET LONG_BINGET; GLOBAL REDUCE BUILD
// BINPERSID.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/input.hpp"

namespace tureen {

class Pickle {
 public:
  /// Index of a value; values may be shared and may contain themselves.
  using Ref = std::uint32_t;

  enum class Kind {
    none,
    boolean,      // integer is 0 or 1
    integer,      // integer
    real,         // real
    text,         // text
    list,         // items
    tuple,        // items
    dict,         // items: key, value, key, value, ..; collections.OrderedDict too
    global,       // text: "module.name", on the list of allowed globals
    persistent,   // items[0]: the id passed to BINPERSID
    constructed,  // items: the global and the argument tuple of REDUCE
  };

  struct Value {
    Kind kind = Kind::none;
    std::int64_t integer = 0;
    double real = 0;
    std::string text{};
    std::vector<Ref> items{};
    std::uint64_t byte = 0;  // of the opcode that created it
  };

  /// Largest size in bytes; larger pickles are rejected. Names and shapes take a few kilobytes, a
  /// training log of a million losses 9 MB.
  static constexpr std::uint64_t max_bytes = 16u << 20;
  static constexpr std::size_t max_values = 1u << 21;

  /// Reads one pickle from the start of `bytes`. Errors print `name` as the file. `globals` are the
  /// allowed ones, "module.name"; collections.OrderedDict is always allowed. BUILD, which sets
  /// attributes, is accepted and its state ignored. Throws InputError.
  Pickle(std::string name, std::span<const std::byte> bytes,
         std::span<const std::string_view> globals, MemoryBudget budget = MemoryBudget());

  const std::string& name() const { return name_; }
  Ref root() const { return root_; }
  const Value& operator[](Ref ref) const { return values_[ref]; }

  /// The value under a text key of a dict, or null. If a key occurs twice the last value counts.
  const Value* find(const Value& dict, std::string_view key) const;

  /// Throws an InputError at the byte that created `value`.
  [[noreturn]] void fail(const Value& value, const std::string& reason,
                         const std::string& hint = {}) const;

 private:
  std::string name_;
  std::vector<Value> values_;
  Ref root_ = 0;
};

/// A kind's name in messages: "a list", "a number", ..
const char* kind_name(Pickle::Kind kind);

}  // namespace tureen
