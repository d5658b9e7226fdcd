#include <chrono>
#include <utility>

#include "runtime/splats/splat_sorter.hpp"

namespace tureen {

void ThreadSplatSorter::begin(std::vector<SplatsInView> views) {
  running_ =
      std::async(std::launch::async, [this, views = std::move(views)] { order_.sort(views); });
}

bool ThreadSplatSorter::take(SplatOrder& order) {
  if (!running_.valid() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return false;
  running_.get();
  std::swap(order, order_);
  return true;
}

void ThreadSplatSorter::forget() {
  if (running_.valid()) running_.wait();
  running_ = {};
}

}  // namespace tureen
