// meta.json of a SOG: the names of its images and the values of their bytes. Version 2 has
// codebooks, version 1 ranges; both become tables of 256 values.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "formats/sog/sog_files.hpp"

namespace tureen {

/// The value of each byte.
using ByteValues = std::array<double, 256>;

struct SogMeta {
  std::string folder = {};  // of its images, with a slash at the end, or empty
  std::uint64_t count = 0;
  /// Range of sign(x) log(1 + |x|) of the centres.
  glm::dvec3 low{0.0}, high{0.0};
  std::string means_low = {}, means_high = {}, scales = {}, rotations = {}, colors = {};
  std::array<ByteValues, 3> scale_values = {};  // sizes, by axis
  std::array<ByteValues, 3> color_values = {};  // harmonics of degree 0, by channel
  ByteValues opacity_values = {};               // 0..1

  /// Harmonics from degree 1 on: for each splat the index of a palette's entry.
  struct Palette {
    std::string entries = {}, indices = {};
    int degree = 0;           // 1..3; 0: that of the width of the image
    std::uint64_t count = 0;  // of entries; 0: as many as the image holds
    ByteValues values = {};
  };
  std::optional<Palette> palette = {};
  const char* profile = "3dgs";  // or "mip", "2dgs"
};

/// Reads `name`, a meta.json. Throws InputError with the file and the place in it, also for a count
/// that images of these sizes cannot hold: at most 1024 splats for each byte of the positions.
/// The count is not checked if the images may_lack.
enum class SogImages { must_exist, may_lack };
SogMeta read_sog_meta(SogFiles& files, const std::string& name,
                      SogImages images = SogImages::must_exist);

}  // namespace tureen
