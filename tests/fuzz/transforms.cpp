// A dataset with this transforms.json, one image and one mask.
#include "formats/dataset/dataset.hpp"
#include "image/png.hpp"
#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void transforms(Bytes bytes) {
  static const Scratch scratch("transforms");
  [[maybe_unused]] static const bool images = [] {
    scratch.write("a.png", encode_png(Image8(8, 6, glm::u8vec4(10, 20, 30, 255))));
    Image8 mask(8, 6, glm::u8vec4(255));
    mask.at(2, 3) = glm::u8vec4(0, 0, 0, 255);
    scratch.write("mask.png", encode_png(mask));
    return true;
  }();
  scratch.write("transforms.json", bytes);
  read_dataset(scratch.folder());
}

}  // namespace tureen::fuzz
