// The configuration of a training run.
#include "tests/fuzz/targets.hpp"
#include "trainer/diffsoup/config_file.hpp"

namespace tureen::fuzz {

void training_config(Bytes bytes) {
  trainer::config_to_json(trainer::read_config(Input::memory("fuzz.json", bytes)));
}

}  // namespace tureen::fuzz
