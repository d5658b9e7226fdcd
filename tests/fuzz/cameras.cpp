// Camera files in JSON: our format, transforms.json, and the format of 3D Gaussian Splatting.
#include "formats/dataset/camera_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void cameras(Bytes bytes) {
  Input input = Input::memory("fuzz.json", bytes);
  cameras_to_json(read_cameras(input).cameras);
}

}  // namespace tureen::fuzz
