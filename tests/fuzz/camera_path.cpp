// A camera path in our format.
#include "formats/dataset/camera_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void camera_path(Bytes bytes) {
  Input input = Input::memory("fuzz.json", bytes);
  path_to_json(read_path(input));
}

}  // namespace tureen::fuzz
