// A palette of vectors, such as the harmonics of splats: k-means in two levels.
//
// The vectors are divided into cells by k-means, each cell gets entries in proportion to
// sqrt(number * squared error), which k-means within the cell places; then all vectors choose among
// the entries of the nearest cells, and entries move to the means. Plain k-means would compare
// 1,000,000 vectors with 65,536 entries in each step: 100 times the work.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tureen {

/// The nearest entry of each vector, among the entries of a number of cells.
class Palette {
 public:
  /// `vectors`: rows of `dimensions` finite numbers, at least one row; the order of rows should be
  /// one in space, since the first entries are rows at equal distances. `weights`: above 0, one per
  /// row. `size`: number of entries, at most 65,536; fewer rows are kept as they are. The result
  /// does not depend on the number of threads.
  Palette(std::span<const float> vectors, std::size_t dimensions, std::span<const float> weights,
          std::size_t size);

  std::size_t count() const { return entries_.size() / dimensions_; }
  /// Rows; similar entries are near each other.
  std::span<const float> entries() const { return entries_; }
  /// The entry of each vector.
  std::span<const std::uint32_t> indices() const { return indices_; }

  /// Replaces the entries by similar ones, such as rounded ones, and chooses the nearest again.
  void replace_entries(std::vector<float> entries);

 private:
  void divide(std::size_t size);
  void find_probes();
  std::size_t probes() const;
  void assign();
  void move_entries();

  std::span<const float> vectors_;
  std::size_t dimensions_;
  std::span<const float> weights_;
  std::vector<float> centers_;        // of the cells: at most 256
  std::vector<std::uint8_t> probes_;  // of each row: the nearest cells, nearest first
  std::vector<std::uint32_t> cells_;  // of each entry: first entry of each cell, and the end
  std::vector<float> entries_;
  std::vector<std::uint32_t> indices_;
};

}  // namespace tureen
