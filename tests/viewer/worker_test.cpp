// The background thread: replaced jobs, queued jobs, failures, and an end during work. The display
// is that of window_test.cpp's environment.
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
  /// A job that records its name on completion.
  Worker::Job job(JobKind kind, const std::string& name) {
    return {.kind = kind,
            .what = name,
            .work =
                [this, name](const Worker::Progress&) {
                  return Worker::Completion([this, name] { told.push_back(name); });
                },
            .failed = [this](const std::string& reason) { told.push_back("failed: " + reason); }};
  }
  /// A job that runs until it is abandoned or `let_go` is set.
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
  worker.start(endless(JobKind::writing, "animation"));
  wait_for_start();
  worker.start(job(JobKind::writing, "image"));
  let_go = true;
  finish(worker);
  EXPECT_THAT(told, ElementsAre("animation", "image"));
}

TEST_F(WorkerTest, AbandonedWorkIsNotHandedOver) {
  Worker worker(window, 0);
  worker.start(endless(JobKind::dataset, "photographs"));
  wait_for_start();
  worker.abandon(JobKind::dataset);
  finish(worker);
  EXPECT_TRUE(told.empty());
}

TEST_F(WorkerTest, PostedCompletionsComeFirst) {
  Worker worker(window, 0);
  Worker::Job posting = job(JobKind::scene, "whole");
  posting.work = [this, &worker, whole = posting.work](const Worker::Progress& progress) {
    worker.post([this] { told.push_back("preview"); });
    return whole(progress);
  };
  worker.start(posting);
  finish(worker);
  EXPECT_THAT(told, ElementsAre("preview", "whole"));
}

TEST_F(WorkerTest, AbandonedJobsPostNothing) {
  Worker worker(window, 0);
  Worker::Job posting = endless(JobKind::scene, "whole");
  posting.work = [this, &worker](const Worker::Progress&) -> Worker::Completion {
    started = true;
    while (true) worker.post([this] { told.push_back("preview"); });
  };
  worker.start(posting);
  wait_for_start();
  worker.abandon(JobKind::scene);
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
  // An exception for a lack of memory must be reported with our own text.
  EXPECT_THAT(told, ElementsAre(HasSubstr("no such file"), Ne("failed: std::bad_alloc")));
}

TEST_F(WorkerTest, KnowsWhenTheProgressChanged) {
  Worker worker(window, 0);
  worker.start(endless(JobKind::scene, "half done"));
  wait_for_start();
  const auto moved = [&] { return worker.status()->moved; };
  while (moved() == 0) std::this_thread::yield();
  const double first = moved();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(moved(), first) << "the progress is the same as before";
  EXPECT_GT(worker.status()->seconds, first);
}

TEST_F(WorkerTest, EndsWhileItWorks) {
  Worker worker(window, 0);
  worker.start(endless(JobKind::scene, "first"));
  worker.start(job(JobKind::drawing, "second"));
  wait_for_start();
}

TEST(Workers, ForecastTheTimeLeftOnceEnoughIsDone) {
  EXPECT_EQ(seconds_left({.what = {}, .fraction = 0.25, .seconds = 10, .moved = 10}), 30.0);
  // It counts down until there is progress, or it is overdue.
  EXPECT_EQ(seconds_left({.what = {}, .fraction = 0.25, .seconds = 30, .moved = 10}), 10.0);
  EXPECT_EQ(seconds_left({.what = {}, .fraction = 0.25, .seconds = 41, .moved = 10}), std::nullopt);
  EXPECT_EQ(seconds_left({.what = {}, .fraction = 0.5, .seconds = 0.1}), std::nullopt);
  EXPECT_EQ(seconds_left({.what = {}, .fraction = 0, .seconds = 10}), std::nullopt);
}

}  // namespace worker_test
}  // namespace tureen::viewer
