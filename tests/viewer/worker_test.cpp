// The thread in the background: what is replaced, what waits, what becomes of failures, and an end
// while it works. The display is that of window_test.cpp's environment.
#include "viewer/worker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>

namespace tureen::viewer {
namespace worker_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Ne;

struct WorkerTest : testing::Test {
  /// A job that notes its name when it is handed over.
  Worker::Job job(JobKind kind, const std::string& name) {
    return {.kind = kind,
            .what = name,
            .work =
                [this, name](const Worker::Progress&) {
                  return Worker::Completion([this, name] { told.push_back(name); });
                },
            .failed = [this](const std::string& reason) { told.push_back("failed: " + reason); }};
  }
  /// One that works until it is abandoned or let go.
  Worker::Job endless(JobKind kind, const std::string& name) {
    Worker::Job result = job(kind, name);
    result.work = [this, name](const Worker::Progress& progress) {
      for (started = true; !let_go;) {
        progress(0.5);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      return Worker::Completion([this, name] { told.push_back(name); });
    };
    return result;
  }
  void wait_for_start() {
    while (!started) std::this_thread::yield();
  }
  void finish(Worker& worker) {
    while (!worker.idle()) {
      worker.collect();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  Window window{{.size = {64, 64}}};
  std::atomic<bool> started{false}, let_go{false};
  std::vector<std::string> told;
};

TEST_F(WorkerTest, TheNewestOfAKindCounts) {
  Worker worker(window, 0);
  worker.start(endless(JobKind::scene, "first"));
  wait_for_start();
  EXPECT_EQ(worker.status()->what, "first");
  worker.start(job(JobKind::scene, "second"));
  worker.start(job(JobKind::drawing, "another kind"));
  worker.start(job(JobKind::scene, "third"));
  finish(worker);
  EXPECT_THAT(told, ElementsAre("another kind", "third"));
}

TEST_F(WorkerTest, WhatIsWrittenWaitsItsTurn) {
  Worker worker(window, 1);
  worker.start(endless(JobKind::writing, "film"));
  wait_for_start();
  worker.start(job(JobKind::writing, "picture"));
  let_go = true;
  finish(worker);
  EXPECT_THAT(told, ElementsAre("film", "picture"));
}

TEST_F(WorkerTest, AbandonedWorkIsNotHandedOver) {
  Worker worker(window, 0);
  worker.start(endless(JobKind::dataset, "photographs"));
  wait_for_start();
  worker.abandon(JobKind::dataset);
  finish(worker);
  EXPECT_TRUE(told.empty());
}

TEST_F(WorkerTest, FailuresAreTold) {
  Worker worker(window, 0);
  Worker::Job bad = job(JobKind::scene, "bad");
  bad.work = [](const Worker::Progress&) -> Worker::Completion {
    throw std::runtime_error("no such file");
  };
  worker.start(bad);
  finish(worker);
  bad.work = [](const Worker::Progress&) -> Worker::Completion { throw std::bad_alloc(); };
  worker.start(bad);
  finish(worker);
  // What is thrown for a lack of memory has no text of its own.
  EXPECT_THAT(told, ElementsAre(HasSubstr("no such file"), Ne("failed: std::bad_alloc")));
}

TEST_F(WorkerTest, EndsWhileItWorks) {
  Worker worker(window, 0);
  worker.start(endless(JobKind::scene, "first"));
  worker.start(job(JobKind::drawing, "second"));
  wait_for_start();
}

}  // namespace worker_test
}  // namespace tureen::viewer
