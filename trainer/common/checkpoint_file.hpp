// The parts that the checkpoints of all methods share.
//
// The bytes: a word of 8 letters for the method, the version (u32), the configuration (as text of a
// --config file), the training views by name, size and checksums, the seconds so far, the state
// member by member, and last a CRC-32 of all before it. A count (u64) precedes texts and arrays.
// Numbers have the byte order of the machine, so a checkpoint needs a machine with the same byte
// order.
//
// The file does not contain the photographs. A version does not read checkpoints of other versions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/input.hpp"
#include "base/output.hpp"
#include "trainer/common/view_fingerprint.hpp"

namespace tureen::trainer {

/// The CRC-32 of bytes after others with the CRC-32 `sum`.
std::uint32_t checksum(std::uint32_t sum, std::span<const std::byte> bytes);

/// Writes values and adds them to the checksum.
class CheckpointWriter {
 public:
  explicit CheckpointWriter(const std::filesystem::path& path) : output_(path) {}

  /// The name of a value is for errors of CheckpointReader only.
  template <class T>
  void operator()(const T& value, const char*) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(std::as_bytes(std::span(&value, 1)));
  }
  template <class T>
  void operator()(const std::vector<T>& values, const char* what) {
    (*this)(std::uint64_t(values.size()), what);
    bytes(std::as_bytes(std::span(values)));
  }
  void operator()(const std::string& text, const char* what) {
    (*this)(std::uint64_t(text.size()), what);
    bytes(std::as_bytes(std::span(text)));
  }

  /// Writes the checksum and completes the file. Throws OutputError.
  void finish();

 private:
  void bytes(std::span<const std::byte> bytes);

  Output output_;
  std::uint32_t sum_ = 0;
};

/// Reads values. Checks each count against the remaining bytes and the memory budget before it
/// allocates memory. Throws InputError.
class CheckpointReader {
 public:
  explicit CheckpointReader(Input& input) : input_(input) {}

  template <class T>
  void operator()(T& value, const char* what) {
    static_assert(std::is_trivially_copyable_v<T>);
    value = input_.read_value<T>(what);
    sum_ = checksum(sum_, std::as_bytes(std::span(&value, 1)));
  }
  template <class T>
  void operator()(std::vector<T>& values, const char* what) {
    values = input_.read_values<T>(count(what), what);
    sum_ = checksum(sum_, std::as_bytes(std::span(values)));
  }
  void operator()(std::string& text, const char* what);

  /// Requires the checksum and the end of the file. Throws InputError.
  void finish();
  const Input& input() const { return input_; }

 private:
  std::uint64_t count(const char* what);

  Input& input_;
  std::uint32_t sum_ = 0;
};

/// The first bytes of a checkpoint; each method of training has its own.
using CheckpointMagic = std::array<char, 8>;

struct CheckpointKind {
  CheckpointMagic magic;
  std::uint32_t version;
};

/// The part of a file before the state.
struct CheckpointHead {
  std::string config;                  // text
  std::vector<ViewFingerprint> views;  // training views, in their order
  double seconds = 0;                  // training time so far
};

void write_head(CheckpointWriter& writer, const CheckpointKind& kind, const CheckpointHead& head);
/// Throws InputError for other kinds and versions.
CheckpointHead read_head(CheckpointReader& reader, const CheckpointKind& kind);

/// The configuration of a head, by `read`(Input). Requires exactly the text that `write` makes from
/// it, because the text from an older or newer version has other fields. Throws InputError.
template <class C, class Read, class Write>
C config_from(const CheckpointHead& head, const Input& file, const Read& read, const Write& write) {
  try {
    const C config = read(Input::memory(file.name(), std::as_bytes(std::span(head.config))));
    if (write(config) == head.config) return config;
  } catch (const InputError& error) {
    throw InputError({file.name(), {}, {}}, "the configuration cannot be used: " + error.reason(),
                     error.hint());
  }
  throw InputError({file.name(), {}, {}},
                   "the configuration has other fields than this version of Tureen needs: resume "
                   "with the version that wrote it");
}

}  // namespace tureen::trainer
