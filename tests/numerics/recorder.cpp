#include "numerics/recorder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "support/measured.hpp"

namespace tureen::test {

namespace {

/// JSON has no infinity.
nlohmann::json error_of(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json("none");
}

int next_number() {
  static const testing::TestInfo* last = nullptr;
  static int count = 0;
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  count = test == last ? count + 1 : 0;
  last = test;
  return count;
}

}  // namespace

Recorder::Recorder(Case what) : case_(std::move(what)), number_(next_number()) {}

void Recorder::add(const Measurement& measured) {
  EXPECT_TRUE(measured.ours <= measured.tolerance)
      << case_.stressed << ", " << case_.parameter << " " << measured.at << ": the error is "
      << measured.ours << " " << case_.unit << ", at most " << measured.tolerance << " is allowed";
  EXPECT_EQ(measured.naive.has_value(), !case_.naive.empty()) << case_.stressed;
  if (measured.naive) {
    const auto message = [&] {
      return case_.stressed + ", " + case_.parameter + " " + std::to_string(measured.at) +
             ": the error of the naive form is " + std::to_string(*measured.naive);
    };
    const bool fails = !(*measured.naive <= measured.tolerance);
    if (case_.naive_fails_from && measured.at >= *case_.naive_fails_from) {
      EXPECT_TRUE(fails) << message();
    }
    if (case_.naive_holds_below && measured.at < *case_.naive_holds_below) {
      EXPECT_FALSE(fails) << message();
    }
  }
  measurements_.push_back(measured);
}

// NOLINTNEXTLINE(bugprone-exception-escape): what cannot be written ends the tests, as it should.
Recorder::~Recorder() {
  EXPECT_FALSE(measurements_.empty()) << case_.stressed << ": nothing was measured";
  if (!case_.naive.empty()) {
    EXPECT_TRUE(std::any_of(measurements_.begin(), measurements_.end(),
                            [](const Measurement& m) { return !(*m.naive <= m.tolerance); }))
        << case_.stressed << ": the naive form (" << case_.naive
        << ") is nowhere worse than allowed";
  }
  const auto any = [&](auto where) {
    return std::any_of(measurements_.begin(), measurements_.end(),
                       [&](const Measurement& m) { return where(m.at); });
  };
  if (const auto from = case_.naive_fails_from) {
    EXPECT_TRUE(any([&](double at) { return at >= *from; })) << case_.stressed;
  }
  if (const auto below = case_.naive_holds_below) {
    EXPECT_TRUE(any([&](double at) { return at < *below; })) << case_.stressed;
  }
  write();
}

void Recorder::write() const {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  nlohmann::json points = nlohmann::json::array();
  for (const Measurement& m : measurements_) {
    nlohmann::json point = {
        {"at", m.at}, {"ours", error_of(m.ours)}, {"tolerance", error_of(m.tolerance)}};
    if (m.naive) point["naive"] = error_of(*m.naive);
    points.push_back(std::move(point));
  }
  const std::string suffix = number_ > 0 ? "-" + std::to_string(number_) : "";
  leave_measured(test->name() + suffix, {{"test", test->name()},
                                         {"stressed", case_.stressed},
                                         {"parameter", case_.parameter},
                                         {"unit", case_.unit},
                                         {"naive", case_.naive},
                                         {"passed", !test->result()->Failed()},
                                         {"points", std::move(points)}});
}

}  // namespace tureen::test
