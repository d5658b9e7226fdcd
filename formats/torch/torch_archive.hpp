// What torch.save wrote, read as data and without Python: a zip archive of one pickle and one file
// of plain numbers a storage (torch 1.6 and later). A tensor is a view into a storage: offset,
// shape and strides, in elements.
//
// Does not read torch's older format, sparse or quantised tensors, or storages saved by big-endian
// machines; they are refused with a sentence.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "formats/torch/pickle.hpp"
#include "formats/torch/zip_archive.hpp"

namespace tureen {

struct TorchTensor {
  enum class Type { f16, bf16, f32, f64, u8, i8, i16, i32, i64 };

  std::string name;  // the key it was found under, for messages
  Type type = Type::f32;
  const ZipEntry* storage = nullptr;
  std::uint64_t offset = 0;
  std::vector<std::uint64_t> shape;
  std::vector<std::uint64_t> strides;
  const Pickle::Value* origin = nullptr;  // for messages

  /// The product of the shape; no more than the storage holds.
  std::uint64_t elements() const;
};

/// "[15000, 561, 7]"
std::string shape_text(const std::vector<std::uint64_t>& shape);

class TorchArchive {
 public:
  /// Throws InputError, also for a pickle with anything that is not on the list (formats/pickle).
  explicit TorchArchive(Input input);

  const Pickle& pickle() const { return *pickle_; }
  /// The value under `key` of the dict that the file holds, or null.
  const Pickle::Value* find(std::string_view key) const;
  /// The same, but throws an InputError when there is none.
  const Pickle::Value& at(std::string_view key) const;

  /// Shape, strides and place of the tensor `value`, checked against its storage.
  TorchTensor tensor(const Pickle::Value& value, std::string name) const;
  TorchTensor tensor(std::string_view key) const { return tensor(at(key), std::string(key)); }
  /// Throws an InputError unless the shape is this one; 0 stands for any size.
  void expect_shape(const TorchTensor& tensor, const std::vector<std::uint64_t>& wanted) const;

  /// All elements in row-major order; of any type.
  std::vector<float> read_floats(const TorchTensor& tensor);
  /// The same for indices; refuses tensors of a floating type.
  std::vector<std::int64_t> read_integers(const TorchTensor& tensor);

  /// An integer (or boolean) value; throws an InputError for any other kind.
  std::int64_t integer(std::string_view key) const;

  /// Counts what is about to be made of a tensor. Throws InputError where that is too much.
  void take_memory(const TorchTensor& tensor, std::uint64_t elements, std::size_t each) const;
  MemoryBudget budget() const { return zip_.budget(); }

  [[noreturn]] void fail(const std::string& reason) const;

 private:
  template <class T>
  std::vector<T> read(const TorchTensor& tensor);

  ZipArchive zip_;
  std::string prefix_;  // of every entry's name, with the slash
  std::unique_ptr<Pickle> pickle_;
};

}  // namespace tureen
