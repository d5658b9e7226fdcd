// Progress of a reader's loops.
#pragma once

#include <cstdint>
#include <functional>

#include "formats/read_options.hpp"

namespace tureen {

/// Calls ReadOptions::progress with the fraction done, 0..1, once every 65,536 steps. The options
/// must outlive it.
class ProgressMeter {
 public:
  explicit ProgressMeter(const ReadOptions& options) : progress_(options.progress) {}
  template <class Fraction>
  void step(Fraction&& fraction) {
    if (++steps_ % 65536 == 0 && progress_) progress_(fraction());
  }

 private:
  const std::function<void(double)>& progress_;
  std::uint64_t steps_ = 0;
};

}  // namespace tureen
