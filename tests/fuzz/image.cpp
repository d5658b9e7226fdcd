// A PNG or a JPEG. The target corrects the checksums of a PNG's chunks, because no fuzzer would
// find them. tests/image/png_test.cpp tests that wrong ones are errors.
#include "image/png.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/image/png_sums.hpp"

namespace tureen::fuzz {

void image(Bytes bytes) {
  decode_image(test::with_png_sums({bytes.begin(), bytes.end()}), "fuzz.png");
}

}  // namespace tureen::fuzz
