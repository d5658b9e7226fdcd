// COLMAP's text files. The first byte selects one of the three.
#include "formats/dataset/colmap.hpp"
#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void colmap_text(Bytes bytes) {
  if (bytes.empty()) return;
  Input input = Input::memory("fuzz.txt", bytes.subspan(1));
  switch (std::to_integer<int>(bytes[0]) % 3) {
    case 0:
      // Readers of datasets skip the photographs of a camera with a defect.
      for (const auto& [number, camera] : read_colmap_cameras_text(input))
        if (!camera.defect.empty()) throw InputError({input.name()}, camera.defect);
      return;
    case 1:
      read_colmap_images_text(input);
      return;
    default:
      read_colmap_points_text(input);
  }
}

}  // namespace tureen::fuzz
