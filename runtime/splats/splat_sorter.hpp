// Sorting of splats while frames are drawn with an earlier order.
#pragma once

#include <future>
#include <vector>

#include "runtime/splats/splat_order.hpp"

namespace tureen {

class SplatSorter {
 public:
  virtual ~SplatSorter() = default;
  /// Begins to sort. The previous sort must be taken or forgotten. The centres must live and stay
  /// unchanged until then.
  virtual void begin(std::vector<SplatsInView> views) = 0;
  /// Exchanges `order` for the result, once it is complete. Returns whether it was.
  virtual bool take(SplatOrder& order) = 0;
  /// Abandons the sort. Afterwards its centres are not read.
  virtual void forget() = 0;
};

/// Sorts in a thread.
class ThreadSplatSorter final : public SplatSorter {
 public:
  ~ThreadSplatSorter() override { forget(); }
  void begin(std::vector<SplatsInView> views) override;
  bool take(SplatOrder& order) override;
  void forget() override;

 private:
  SplatOrder order_;
  std::future<void> running_;
};

}  // namespace tureen
