// SPZ. The first byte selects the file as it is, or the content of a gzip file, whose checksum a
// fuzzer cannot guess.
#include "formats/splat/spz.hpp"

#include "tests/formats/splat/spz_fixture.hpp"
#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void spz(Bytes bytes) {
  if (bytes.empty()) return;
  const bool is_content = bytes[0] != std::byte{0};
  bytes = bytes.subspan(1);
  const std::string packed =
      is_content ? test::gzipped({reinterpret_cast<const char*>(bytes.data()), bytes.size()})
                 : std::string();
  if (is_content) bytes = test::as_bytes(packed);
  is_spz(bytes);
  Input input = Input::memory("fuzz.spz", bytes);
  require_whole(read_spz(input));
}

}  // namespace tureen::fuzz
