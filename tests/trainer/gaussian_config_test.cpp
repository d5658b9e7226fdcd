// The table of constants of Gaussians, compared with the struct, and their files.
#include "trainer/splats/gaussians/gaussian_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "base/error.hpp"
#include "tests/support/errors.hpp"

namespace tureen::trainer {
namespace gaussian_config_test {

using tureen::test::error_of;
using tureen::test::ErrorAt;

GaussianConfig read(const std::string& text, const GaussianConfig& defaults = {}) {
  return read_splat_config<GaussianConfig>(
      Input::memory("run.json", std::as_bytes(std::span(text))), defaults);
}

/// Converts to any type in an aggregate initialiser.
struct Anything {
  template <class T>
  operator T() const;
};

/// The number of values in a SplatConfig: an initialiser with one more is ill-formed.
template <class... Values>
constexpr int value_count() {
  if constexpr (requires { SplatConfig{Values{}..., Anything{}}; })
    return value_count<Values..., Anything>();
  else
    return int(sizeof...(Values));
}

TEST(GaussianConfigFields, AreAllMembersOnceAndInOrder) {
  int values = 0;
  const GaussianConfig config;
  const char* last = nullptr;
  std::set<std::string> names;
  for (const GaussianConfig::Field& field : splat_config_fields<GaussianConfig>()) {
    values += std::holds_alternative<Color GaussianConfig::*>(field.member) ? 3 : 1;
    const char* address =
        std::visit([&](auto member) { return reinterpret_cast<const char*>(&(config.*member)); },
                   field.member);
    EXPECT_LT(last, address) << field.name << " does not follow the field before it";
    last = address;
    EXPECT_TRUE(names.insert(field.name).second) << field.name << " is listed twice";
    EXPECT_EQ(numbers(config, field).empty(), std::string(field.range.reason).empty());
  }
  EXPECT_EQ(values, value_count<>() + 3);  // and flat, and the scales
  EXPECT_FALSE(splat_config_defect(config));
}

TEST(GaussianConfigFile, ComesBackToTheBit) {
  GaussianConfig config;
  config.steps = 123;
  config.max_splats = 7'654'321;
  config.degree_steps = 0.1 + 1e-17;
  config.densify_until = 1.0 / 3;
  config.flat = true;
  config.min_scale = 1.1e-5f;
  config.background[1] = 0.3f;
  config.seed = 18446744073709551615u;
  config.initialisation = Initialisation::random;
  config.minutes = 2.7;
  const GaussianConfig same = read(splat_config_to_json(config));
  EXPECT_FALSE(first_difference(config, same, splat_config_fields<GaussianConfig>()));
  EXPECT_EQ(same.densify_until, config.densify_until);
  EXPECT_EQ(same.seed, config.seed);
  // Fields that a file does not name keep the given defaults.
  EXPECT_EQ(read(R"({"steps": 7})", config).minutes, 2.7);
}

TEST(GaussianConfigFile, ReportsErrors) {
  const auto expect = [](const std::string& text, const auto&... values) {
    EXPECT_THAT(error_of([&] { read(text); }), ErrorAt("run.json", values...)) << text;
  };
  expect("[]");
  expect(R"({"stepz": 5})", "stepz", "steps");
  expect(R"({"steps": 0})", "steps", 0, 1);
  expect(R"({"steps": 2.5})", "steps", 2.5);
  expect(R"({"max_splats": -1})", "max_splats");
  expect(R"({"max_splats": 20000000})", "max_splats", 20000000, 10000000);
  expect(R"({"degree": 4})", "degree", 4, 3);
  expect(R"({"densify_until": 1.5})", "densify_until", 1.5);
  expect(R"({"min_scale": 2})", "min_scale", 2, "max_scale", 1);
  expect(R"({"l1_weight": 0, "ssim_weight": 0})", "l1_weight");
  expect(R"({"initialisation": "pionts"})", "initialisation", "pionts", "points");
}

TEST(GaussianConfigDifference, IgnoresStepsThatWereFitted) {
  GaussianConfig now, checkpoint;
  checkpoint.steps = 700;
  EXPECT_THAT(splat_config_difference(now, checkpoint).value_or(""), testing::HasSubstr("steps"));
  now.minutes = checkpoint.minutes = 3;
  EXPECT_FALSE(splat_config_difference(now, checkpoint));
  now.minutes = 4;
  EXPECT_THAT(splat_config_difference(now, checkpoint).value_or(""), testing::HasSubstr("minutes"));
}

TEST(GaussianConfigReference, HasEveryField) {
  const std::string text = splat_config_reference<GaussianConfig>();
  for (const GaussianConfig::Field& field : splat_config_fields<GaussianConfig>())
    EXPECT_THAT(text, testing::HasSubstr(std::string(field.name) + ": " +
                                         value_text(GaussianConfig{}, field)))
        << field.name;
}

}  // namespace gaussian_config_test
}  // namespace tureen::trainer
