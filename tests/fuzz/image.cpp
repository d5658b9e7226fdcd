// A PNG or a JPEG. The chunks of a PNG get the checksums that their bytes have, which no fuzzer
// would find; that others are refused is in tests/formats/png_test.cpp.
#include "formats/png.hpp"
#include "tests/formats/png_sums.hpp"
#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void image(Bytes bytes) {
  decode_image(test::with_png_sums({bytes.begin(), bytes.end()}), "fuzz.png");
}

}  // namespace tureen::fuzz
