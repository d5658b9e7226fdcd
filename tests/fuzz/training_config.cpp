// The configuration of a training run.
#include "tests/fuzz/targets.hpp"
#include "trainer/diffsoup/config_file.hpp"

namespace tureen::fuzz {

void training_config(Bytes bytes) {
  Input input = Input::memory("fuzz.json", bytes);
  trainer::config_to_json(trainer::read_config(input));
}

}  // namespace tureen::fuzz
