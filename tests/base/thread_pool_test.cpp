#include "base/threads/thread_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace tureen {
namespace thread_pool_test {

TEST(ThreadPool, EveryTaskRunsOnce) {
  for (const int threads : {1, 2, 3, 8}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    // Runs in immediate succession, so that workers may not be asleep yet.
    for (const std::size_t tasks : {0u, 1u, 2u, 1000u, 3u, 0u, 17u}) {
      std::vector<std::atomic<int>> runs(tasks);
      pool.run(tasks, [&](std::size_t task) { ++runs.at(task); });
      for (std::size_t task = 0; task < tasks; ++task)
        ASSERT_EQ(runs[task], 1) << threads << " threads, task " << task << " of " << tasks;
    }
  }
}

TEST(ThreadPool, ManyShortRunsLoseNoTask) {
  ThreadPool pool(4);
  for (int run = 0; run < 5000; ++run) {
    std::atomic<int> sum = 0;
    pool.run(3, [&](std::size_t task) { sum += int(task) + 1; });
    ASSERT_EQ(sum, 6) << "run " << run;
  }
}

TEST(ThreadPool, TasksRunSideBySide) {
  ThreadPool pool(3);
  std::atomic<int> arrived = 0;
  std::atomic<bool> met = true;
  pool.run(3, [&](std::size_t) {
    // Each task waits for the others, which needs three threads. A minute is long enough to
    // schedule them.
    ++arrived;
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (arrived < 3 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    if (arrived < 3) met = false;
  });
  EXPECT_TRUE(met);
}

TEST(ThreadPool, NoneMeansAllCores) {
  EXPECT_EQ(ThreadPool().threads(), int(std::max(1u, std::thread::hardware_concurrency())));
}

TEST(ThreadPool, AnExceptionEndsTheRunAndIsThrownByIt) {
  ThreadPool pool(1);
  std::vector<std::size_t> begun;
  const auto body = [&](std::size_t task) {
    begun.push_back(task);
    if (task == 2) throw std::runtime_error("task 2");
  };
  try {
    pool.run(10, body);
    FAIL() << "no exception";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()), "task 2");
  }
  EXPECT_EQ(begun, (std::vector<std::size_t>{0, 1, 2}));
}

TEST(ThreadPool, AnExceptionOfAnotherThreadLeavesThePoolUsable) {
  ThreadPool pool(4);
  for (int round = 0; round < 100; ++round) {
    EXPECT_THROW(pool.run(50, [](std::size_t) { throw std::runtime_error("all fail"); }),
                 std::runtime_error);
    std::atomic<int> runs = 0;
    pool.run(50, [&](std::size_t) { ++runs; });
    ASSERT_EQ(runs, 50) << "round " << round;
  }
}

}  // namespace thread_pool_test
}  // namespace tureen
