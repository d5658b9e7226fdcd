// A PNG or a JPEG. The chunks of a PNG get the checksums that their bytes have, which no fuzzer
// would find; that others are refused is in tests/image/png_test.cpp.
#include "image/png.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/image/png_sums.hpp"

namespace tureen::fuzz {

void image(Bytes bytes) {
  decode_image(test::with_png_sums({bytes.begin(), bytes.end()}), "fuzz.png");
}

}  // namespace tureen::fuzz
