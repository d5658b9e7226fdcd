// A dataset with this transforms.json and one image.
#include "formats/dataset/dataset.hpp"
#include "image/png.hpp"
#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void transforms(Bytes bytes) {
  static const Scratch scratch("transforms");
  [[maybe_unused]] static const bool image =
      (scratch.write("a.png", encode_png(Image8(8, 6, glm::u8vec4(10, 20, 30, 255)))), true);
  scratch.write("transforms.json", bytes);
  read_dataset(scratch.folder());
}

}  // namespace tureen::fuzz
