// Bundler's files. The first byte selects the model or the list of images.
#include "formats/dataset/bundler.hpp"

#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void bundler(Bytes bytes) {
  if (bytes.empty()) return;
  Input input = Input::memory("fuzz.out", bytes.subspan(1));
  if (std::to_integer<int>(bytes[0]) % 2 == 0)
    read_bundler(input);
  else
    read_bundler_list(input);
}

}  // namespace tureen::fuzz
