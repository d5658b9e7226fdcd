#include "tests/numerics/recorder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "tests/support/measured.hpp"

namespace tureen::test {

Recorder::Recorder(Case what) : case_(std::move(what)) {}

void Recorder::add(const Measurement& measured) {
  EXPECT_TRUE(measured.ours <= measured.tolerance)
      << case_.stressed << ", " << case_.parameter << " " << measured.at << ": the error is "
      << measured.ours << " " << case_.unit << ", at most " << measured.tolerance << " is allowed";
  EXPECT_EQ(measured.naive.has_value(), !case_.naive.empty()) << case_.stressed;
  if (measured.naive) {
    const auto message = [&] {
      return case_.stressed + ", " + case_.parameter + " " + std::to_string(measured.at) +
             ": the error of the naive method is " + std::to_string(*measured.naive);
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

// NOLINTNEXTLINE(bugprone-exception-escape): a failed write must end the tests.
Recorder::~Recorder() {
  EXPECT_FALSE(measurements_.empty()) << case_.stressed << ": nothing was measured";
  if (!case_.naive.empty()) {
    EXPECT_TRUE(std::any_of(measurements_.begin(), measurements_.end(),
                            [](const Measurement& m) { return !(*m.naive <= m.tolerance); }))
        << case_.stressed << ": the naive method (" << case_.naive
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
  // Numbers that are not finite become null.
  nlohmann::json points = nlohmann::json::array();
  for (const Measurement& m : measurements_) {
    nlohmann::json point = {{"at", m.at}, {"ours", m.ours}, {"tolerance", m.tolerance}};
    if (m.naive) point["naive"] = *m.naive;
    points.push_back(std::move(point));
  }
  const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
  leave_measured("numerics", {{"case", test.substr(0, test.find('_'))},
                              {"stressed", case_.stressed},
                              {"parameter", case_.parameter},
                              {"quantity", case_.unit},
                              {"naive_form", case_.naive},
                              {"points", std::move(points)}});
}

}  // namespace tureen::test
