// Files of torch.save (torch 1.6 and later), read as data without Python: a zip archive with one
// pickle and one file of plain numbers a storage. A tensor is a view into a storage: offset, shape
// and strides, in elements.
//
// Not supported: torch's older format, sparse or quantised tensors, and storages from big-endian
// machines. The error names the reason.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "formats/archive/zip_archive.hpp"
#include "formats/torch/pickle.hpp"

namespace tureen {

struct TorchTensor {
  enum class Type { f16, bf16, f32, f64, u8, i8, i16, i32, i64 };

  std::string name;  // its key in the file, for messages
  Type type = Type::f32;
  const ZipEntry* storage = nullptr;
  std::uint64_t offset = 0;
  std::vector<std::uint64_t> shape;
  std::vector<std::uint64_t> strides;
  const Pickle::Value* origin = nullptr;  // for messages

  /// The product of the shape; at most the elements of the storage.
  std::uint64_t elements() const;
};

/// In the wanted shape of a tensor.
inline constexpr std::uint64_t any_size = std::numeric_limits<std::uint64_t>::max();

/// "[15000, 561, 7]", "[any, 3]"
std::string shape_text(const std::vector<std::uint64_t>& shape);

class TorchArchive {
 public:
  /// Throws InputError, also for a pickle with an opcode or global that is not allowed
  /// (formats/torch/pickle.hpp).
  explicit TorchArchive(Input input);

  const Pickle& pickle() const { return *pickle_; }
  /// The value under `key` of the file's dict, or null.
  const Pickle::Value* find(std::string_view key) const;
  /// The same, but throws InputError if it is missing.
  const Pickle::Value& at(std::string_view key) const;

  /// Shape, strides and offset of the tensor `value`, checked against its storage.
  TorchTensor tensor(const Pickle::Value& value, std::string name) const;
  TorchTensor tensor(std::string_view key) const { return tensor(at(key), std::string(key)); }
  /// Throws InputError if the shape differs; any_size matches every size.
  void expect_shape(const TorchTensor& tensor, const std::vector<std::uint64_t>& wanted) const;

  /// All elements in row-major order, converted from any type.
  std::vector<float> read_floats(const TorchTensor& tensor);
  /// The same for indices; rejects tensors of a floating-point type.
  std::vector<std::int64_t> read_integers(const TorchTensor& tensor);

  /// An integer (or boolean) value. Throws InputError for any other kind.
  std::int64_t integer(std::string_view key) const;
  /// A float or integer value. Throws InputError for any other kind.
  double number(std::string_view key) const;

  /// Counts the memory for a tensor's values. Throws InputError beyond the budget.
  void take_memory(const TorchTensor& tensor, std::uint64_t elements, std::size_t each) const;
  MemoryBudget budget() const { return zip_.budget(); }

  [[noreturn]] void fail(const std::string& reason) const;

 private:
  template <class T>
  std::vector<T> read(const TorchTensor& tensor);

  ZipArchive zip_;
  std::string prefix_;  // of all entry names, with the slash
  std::unique_ptr<Pickle> pickle_;
};

}  // namespace tureen
