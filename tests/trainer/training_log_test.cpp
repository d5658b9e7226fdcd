#include "trainer/common/training_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "base/error.hpp"
#include "tests/support/errors.hpp"

namespace tureen::trainer {
namespace training_log_test {

namespace fs = std::filesystem;

class Log : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path = fs::path(testing::TempDir()) / (std::string("tureen_log_") + info->name() + ".jsonl");
    fs::remove(path);
  }
  void TearDown() override { fs::remove(path); }

  std::string text() const {
    std::stringstream all;
    all << std::ifstream(path, std::ios::binary).rdbuf();
    return all.str();
  }
  void write(const std::string& content) const { std::ofstream(path, std::ios::binary) << content; }
  std::optional<tureen::test::Refusal> refusal() const {
    return tureen::test::error_of([&] { read_training_log(path); });
  }

  fs::path path;
};

TrainingRecord record(int step) {
  TrainingRecord result{
      .step = step,
      .seconds = step / 7.0,
      .loss = 1.0 / step,
      .l1 = 0.5 / step,
      .ssim = 1 - 1.0 / step,
      .train_psnr_db = 20 + step / 1000.0,
      .primitives = {step % 200 == 0 ? PrimitiveKind::splats : PrimitiveKind::triangles,
                     std::size_t(15000 + step)},
      .it_per_second = 7.1,
      .non_finite = std::size_t(step / 100)};
  if (step % 200 == 0) result.test_psnr_db = 19 + step / 1000.0;
  if (step % 300 == 0) result.steps = 10 * step;
  result.ended_early = step == 500;
  return result;
}

void expect_equal(const TrainingRecord& a, const TrainingRecord& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.seconds, b.seconds);
  EXPECT_EQ(a.loss, b.loss);
  EXPECT_EQ(a.l1, b.l1);
  EXPECT_EQ(a.ssim, b.ssim);
  EXPECT_EQ(a.train_psnr_db, b.train_psnr_db);
  EXPECT_EQ(a.test_psnr_db, b.test_psnr_db);
  EXPECT_EQ(a.primitives.kind, b.primitives.kind);
  EXPECT_EQ(a.primitives.count, b.primitives.count);
  EXPECT_EQ(a.it_per_second, b.it_per_second);
  EXPECT_EQ(a.non_finite, b.non_finite);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.ended_early, b.ended_early);
}

TEST_F(Log, IsWholeAfterEveryLine) {
  TrainingLog log = TrainingLog::create(path);
  for (int step = 100; step <= 500; step += 100) {
    log.append(record(step));
    const std::vector<TrainingRecord> read = read_training_log(path);
    ASSERT_EQ(int(read.size()), step / 100);
    expect_equal(read.back(), record(step));
  }
  EXPECT_THAT(text(), testing::StartsWith("{\"step\":100,\"seconds\":"));
}

TEST_F(Log, KeepsWhatIsNoNumber) {
  TrainingRecord bad = record(100);
  bad.loss = std::numeric_limits<double>::quiet_NaN();
  bad.train_psnr_db = -std::numeric_limits<double>::infinity();
  TrainingLog::create(path).append(bad);
  const TrainingRecord read = read_training_log(path).at(0);
  EXPECT_TRUE(std::isnan(read.loss));
  EXPECT_TRUE(std::isnan(read.train_psnr_db));
  EXPECT_EQ(read.l1, bad.l1);
}

TEST_F(Log, ResumesAfterAStepAsIfItHadNotGoneOn) {
  {
    TrainingLog log = TrainingLog::create(path);
    for (int step = 100; step <= 300; step += 100) log.append(record(step));
  }
  const std::string three = text();
  {
    TrainingLog log = TrainingLog::resume(path, 399);
    EXPECT_EQ(text(), three);
    log.append(record(400));
    log.append(record(500));
  }
  const std::string five = text();
  write(five + "{\"step\":600,\"sec");  // cut short
  {
    TrainingLog log = TrainingLog::resume(path, 300);
    EXPECT_EQ(text(), three);
    log.append(record(400));
    log.append(record(500));
  }
  EXPECT_EQ(text(), five);
  TrainingLog::resume(path, 0);
  EXPECT_EQ(text(), "");
  fs::remove(path);
  TrainingLog::resume(path, 300).append(record(400));
  EXPECT_EQ(read_training_log(path).size(), 1u);
}

TEST_F(Log, BeginsWithThePlanOfItsRun) {
  {
    TrainingLog log = TrainingLog::create(path);
    log.append_plan(R"({"steps":300,"text":["300 steps","CPU"]})");
    log.append(record(100));
    log.append(record(200));
  }
  TrainingLogTail tail(path);
  EXPECT_TRUE(tail.update());
  EXPECT_EQ(tail.plan(), (std::vector<std::string>{"300 steps", "CPU"}));
  EXPECT_EQ(tail.records().size(), 2u);
  const std::string plan = text().substr(0, text().find('\n') + 1);
  TrainingLog::resume(path, 150);
  EXPECT_TRUE(tail.update());
  EXPECT_EQ(tail.records().size(), 1u);
  TrainingLog::resume(path, 0);
  EXPECT_EQ(text(), plan);
  // The number of a wrong line counts the plan's; a second plan is no record.
  write(plan + plan);
  ASSERT_TRUE(refusal());
  EXPECT_EQ(refusal()->position, ":2");
}

TEST_F(Log, IsReadAtEveryLengthThatARunMayLeave) {
  {
    TrainingLog log = TrainingLog::create(path);
    for (int step = 100; step <= 300; step += 100) log.append(record(step));
  }
  const std::string whole = text();
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    write(whole.substr(0, length));
    const auto lines = std::count(whole.begin(), whole.begin() + std::ptrdiff_t(length), '\n');
    ASSERT_EQ(std::ptrdiff_t(read_training_log(path).size()), lines) << length;
  }
}

TEST_F(Log, IsFollowedLineByLine) {
  TrainingLogTail tail(path);
  EXPECT_FALSE(tail.update());  // no file
  std::string whole;
  {
    TrainingLog log = TrainingLog::create(path);
    for (int step = 100; step <= 300; step += 100) log.append(record(step));
    whole = text();
  }
  fs::remove(path);
  for (std::size_t length = 1; length <= whole.size(); ++length) {
    write(whole.substr(0, length));
    ASSERT_TRUE(tail.update()) << length;
    ASSERT_FALSE(tail.update()) << length;
    const auto lines = std::count(whole.begin(), whole.begin() + std::ptrdiff_t(length), '\n');
    ASSERT_EQ(std::ptrdiff_t(tail.records().size()), lines) << length;
  }
  for (std::size_t i = 0; i < 3; ++i) expect_equal(tail.records().at(i), record(int(i + 1) * 100));

  // A wrong line; the ones before it stay.
  write(whole + "hello\n");
  EXPECT_THROW(tail.update(), InputError);
  EXPECT_EQ(tail.records().size(), 3u);
  EXPECT_FALSE(tail.update());
  // A shorter log of another run, and a longer one.
  TrainingLog::create(path).append(record(50));
  EXPECT_TRUE(tail.update());
  ASSERT_EQ(tail.records().size(), 1u);
  EXPECT_EQ(tail.records().front().step, 50);
  write(whole);
  EXPECT_TRUE(tail.update());
  EXPECT_EQ(tail.records().size(), 3u);
  fs::remove(path);
  EXPECT_TRUE(tail.update());
  EXPECT_TRUE(tail.records().empty());
}

TEST_F(Log, SaysWhichLineIsWrong) {
  using tureen::test::ErrorAt;
  const std::string name = path.filename().string();
  TrainingLog::create(path).append(record(100));
  const std::string line = text();
  write(line + "hello\n");
  EXPECT_THAT(refusal(), ErrorAt(name + ":2"));
  write(line + "{\"step\": 200}\n");
  EXPECT_THAT(refusal(), ErrorAt(name + ":2", "seconds"));
  write(line + "[1]\n");
  EXPECT_THAT(refusal(), ErrorAt(name + ":2"));
  write(line + line);
  EXPECT_THAT(refusal(), ErrorAt(name + ":2", 100));
  EXPECT_THROW(TrainingLog::resume(path, 100), InputError);
  EXPECT_EQ(text(), line + line);  // untouched
  fs::remove(path);
  EXPECT_THAT(refusal(), ErrorAt(name));
}

TEST_F(Log, SaysThatItCannotBeWritten) {
  EXPECT_THROW(TrainingLog::create(path / "below"), OutputError);
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  TrainingLog full = TrainingLog::create("/dev/full");
  EXPECT_THROW(full.append(record(100)), OutputError);
}

}  // namespace training_log_test
}  // namespace tureen::trainer
