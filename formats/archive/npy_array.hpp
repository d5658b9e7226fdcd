// An array of NumPy in an .npz archive (numpy.savez, numpy.savez_compressed), read. The .npy format
// has versions 1 to 3: https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html
//
// Supported are one or two dimensions of little-endian numbers: floats of 4 or 8 bytes, and
// integers. Structured types, objects (pickles) and other types are rejected.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "formats/archive/zip_archive.hpp"

namespace tureen {

class NpyArray {
 public:
  /// Reads the entry `name`.npy as a whole. Throws InputError if it is missing or damaged, or holds
  /// no such array.
  NpyArray(ZipArchive& archive, const std::string& name);

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  bool holds_floats() const { return kind_ == Kind::floats; }
  /// row < rows(), column < columns(). Integers beyond 2^53 are rounded.
  double at(std::size_t row, std::size_t column) const;

  /// Throws an InputError about this array.
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  enum class Kind { floats, integers, naturals };
  void read_header();
  void set_type(const std::string& type);

  const ZipArchive& archive_;
  const ZipEntry& entry_;
  std::vector<std::byte> bytes_;
  std::size_t data_ = 0;  // place in bytes_
  std::size_t rows_ = 0, columns_ = 1, size_ = 0;
  Kind kind_ = Kind::floats;
  bool by_columns_ = false;  // "fortran_order"
};

}  // namespace tureen
