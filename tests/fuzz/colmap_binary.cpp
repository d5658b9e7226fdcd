// COLMAP's binary files. The first byte selects one of the four readers.
#include "formats/dataset/colmap.hpp"
#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void colmap_binary(Bytes bytes) {
  if (bytes.empty()) return;
  Input input = Input::memory("fuzz.bin", bytes.subspan(1));
  switch (std::to_integer<int>(bytes[0]) % 4) {
    case 0:
      // Readers of datasets skip the photographs of a camera with a defect.
      for (const auto& [number, camera] : read_colmap_cameras_binary(input))
        if (!camera.defect.empty()) throw InputError({input.name()}, camera.defect);
      return;
    case 1:
      read_colmap_images_binary(input);
      return;
    case 2:
      read_colmap_points_binary(input);
      return;
    default:
      read_colmap_tracks_binary(input);
  }
}

}  // namespace tureen::fuzz
