#include "base/threads/on_all_cores.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace tureen {
namespace on_all_cores_test {

TEST(OnAllCores, DoesEachPieceOnce) {
  std::vector<std::atomic<int>> times(100);
  double last = 0;
  on_all_cores(
      times.size(), [&](double done) { last = done; },
      [&](std::size_t i, const auto& check) {
        check(0);
        ++times[i];
      });
  for (const auto& each : times) EXPECT_EQ(each, 1);
  EXPECT_LE(last, 1);
}

/// The first thread would otherwise work for ever, and the caller waits for it first.
TEST(OnAllCores, EndsAllWorkWhenOnePieceFails) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "needs two threads";
  const auto work = [](std::size_t i, const std::function<void(double)>& check) {
    if (i > 0) throw std::runtime_error("piece " + std::to_string(i));
    for (;; std::this_thread::yield()) check(0);
  };
  EXPECT_THROW(on_all_cores(
                   2, [](double) {}, work),
               std::runtime_error);
}

TEST(OnAllCores, EndsWhenTheProgressThrows) {
  struct Stop {};
  const auto work = [](std::size_t, const std::function<void(double)>& check) {
    for (;; std::this_thread::yield()) check(0);
  };
  EXPECT_THROW(on_all_cores(
                   8, [](double) { throw Stop(); }, work),
               Stop);
}

}  // namespace on_all_cores_test
}  // namespace tureen
