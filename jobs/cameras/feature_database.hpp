// What COLMAP's database holds (https://colmap.github.io/database.html): features of photographs,
// and pairs of photographs that show the same. Only reads.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <memory>
#include <string>
#include <vector>

struct sqlite3;

namespace tureen {

/// A SIFT descriptor.
using FeatureDescriptor = std::array<std::uint8_t, 128>;

class FeatureDatabase {
 public:
  /// Throws InputError if the file cannot be read, as do all functions.
  explicit FeatureDatabase(const std::filesystem::path& file);

  struct Photo {
    std::uint32_t number = 0;  // COLMAP's
    std::uint32_t camera = 0;
    std::uint64_t features = 0;
    std::string name;
  };
  /// By number.
  std::vector<Photo> photos() const;

  /// At most `most` descriptors of a photograph, evenly chosen.
  std::vector<FeatureDescriptor> descriptors(std::uint32_t photo, std::size_t most) const;

  /// A pair of photographs with verified matches.
  struct Pair {
    std::uint32_t first = 0, second = 0;  // Photo::number
    std::uint64_t matches = 0;
    /// Whether one homography explains the matches: the photographs show a plane, or were taken
    /// from one point.
    bool is_flat = false;
    glm::dmat3 second_from_first{0.0};  // the homography, between pixels; 0 if there is none
  };
  std::vector<Pair> pairs() const;

 private:
  struct Close {
    void operator()(sqlite3* database) const;
  };
  std::string file_;
  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace tureen
