// A PNG or a JPEG.
#include "formats/png.hpp"
#include "fuzz/targets.hpp"

namespace tureen::fuzz {

void image(Bytes bytes) { decode_image(bytes, "fuzz.png"); }

}  // namespace tureen::fuzz
