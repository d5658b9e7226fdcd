// The log of a training run.
#include "trainer/common/training_log.hpp"

#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void training_log(Bytes bytes) {
  static const Scratch scratch("log");
  scratch.write("run.jsonl", bytes);
  trainer::read_training_log(scratch.folder() / "run.jsonl");
}

}  // namespace tureen::fuzz
