// How threads share splats.
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/threads/thread_pool.hpp"

namespace tureen::trainer {

/// Splats of a task, a multiple of splatting::row_alignment.
inline constexpr std::size_t splats_a_task = 1024;

/// Calls act(begin, end) for all tasks of `count` splats.
template <class Act>
void run_in_tasks(ThreadPool& pool, std::size_t count, const Act& act) {
  pool.run((count + splats_a_task - 1) / splats_a_task, [&](std::size_t task) {
    const std::size_t begin = task * splats_a_task;
    act(begin, std::min(begin + splats_a_task, count));
  });
}

}  // namespace tureen::trainer
