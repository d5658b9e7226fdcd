// A training checkpoint in our format, of any method. The bytes come without their
// checksum, because no fuzzer would find it.
#include <zlib.h>

#include <cstring>
#include <utility>
#include <vector>

#include "tests/fuzz/targets.hpp"
#include "trainer/diffsoup/checkpoint.hpp"
#include "trainer/splats/splat_state.hpp"

namespace tureen::fuzz {

void training_checkpoint(Bytes bytes) {
  const auto sum = std::uint32_t(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
  std::vector<std::byte> whole(bytes.begin(), bytes.end());
  whole.resize(bytes.size() + sizeof sum);
  std::memcpy(whole.data() + bytes.size(), &sum, sizeof sum);
  Input input = Input::memory("fuzz.checkpoint", whole);
  const auto last = bytes.size() > 7 ? char(bytes[7]) : '\0';  // of the magic bytes
  if (last == trainer::gaussians_magic.back())
    trainer::read_splat_checkpoint<trainer::GaussianCheckpoint>(std::move(input));
  else if (last == trainer::neural_magic.back())
    trainer::read_splat_checkpoint<trainer::NeuralCheckpoint>(std::move(input));
  else if (last == trainer::triangles_magic.back())
    trainer::read_splat_checkpoint<trainer::WindowCheckpoint>(std::move(input));
  else
    trainer::read_checkpoint(std::move(input));
}

}  // namespace tureen::fuzz
