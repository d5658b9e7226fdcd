// A pickle as torch writes it, without the archive around it.
#include "formats/torch/pickle.hpp"

#include <array>

#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

void pickle(Bytes bytes) {
  static constexpr std::array<std::string_view, 3> globals{
      "torch._utils._rebuild_tensor_v2", "torch._utils._rebuild_parameter", "torch.FloatStorage"};
  const Pickle read("fuzz.pkl", bytes, globals);
  read.find(read[read.root()], "feat_acc");
}

}  // namespace tureen::fuzz
