// A result of `tureen tradeoff`, which --import joins with others.
#include "cli/tradeoff_reading.hpp"
#include "cli/tradeoff_scenes.hpp"
#include "fuzz/targets.hpp"

namespace tureen::fuzz {

void tradeoff_result(Bytes bytes) {
  Input input = Input::memory("fuzz.json", bytes);
  cli::TradeoffReport report = cli::read_tradeoff(input);
  cli::TradeoffReport other = report;
  other.scene.name += " of another name";
  cli::join({{"fuzz.json", std::move(report)}, {"other.json", std::move(other)}});
}

}  // namespace tureen::fuzz
