// Configurations: the table of fields compared with the struct, and configuration files.
#include "trainer/diffsoup/config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <set>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "tests/support/errors.hpp"
#include "trainer/diffsoup/config_fields.hpp"
#include "trainer/diffsoup/config_file.hpp"

namespace tureen::trainer {
namespace config_test {

using testing::HasSubstr;
using testing::StartsWith;
using tureen::test::error_of;
using tureen::test::ErrorAt;
using tureen::test::ErrorIn;
using tureen::test::Names;
using tureen::test::Refusal;

Config read(const std::string& text, const ConfigDefaults& defaults = {}) {
  return read_config(Input::memory("run.json", std::as_bytes(std::span(text))), defaults);
}

std::optional<Refusal> refusal(const std::string& text) {
  return error_of([&] { read(text); });
}

// --- The table ------------------------------------------------------------------------------

/// Converts to any type in an aggregate initialiser.
struct Anything {
  template <class T>
  operator T() const;
};

/// The number of values in a Config: an initialiser with one more is ill-formed.
template <class... Values>
constexpr int value_count() {
  if constexpr (requires { Config{Values{}..., Anything{}}; })
    return value_count<Values..., Anything>();
  else
    return int(sizeof...(Values));
}

int values_of(const ConfigField& field) {
  return std::holds_alternative<Color Config::*>(field.member) ? 3 : 1;
}

TEST(ConfigFields, AreAllMembersOfConfigOnceAndInOrder) {
  int values = 0;
  const Config config;
  const char* last = nullptr;
  std::set<std::string> names;
  for (const ConfigField& field : config_fields()) {
    values += values_of(field);
    const char* address =
        std::visit([&](auto member) { return reinterpret_cast<const char*>(&(config.*member)); },
                   field.member);
    EXPECT_LT(last, address) << field.name << " does not follow the field before it in Config";
    last = address;
    EXPECT_TRUE(names.insert(field.name).second) << field.name << " is listed twice";
    EXPECT_FALSE(std::string(field.meaning).empty()) << field.name;
  }
  // The members are distinct and their number is right, so they are all members.
  EXPECT_EQ(values, value_count<>())
      << "Config has members that trainer/diffsoup/config_fields.cpp does not list, or the reverse";
}

TEST(ConfigFields, HaveAReasonForEveryRange) {
  for (const ConfigField& field : config_fields()) {
    const bool number = std::holds_alternative<int Config::*>(field.member) ||
                        std::holds_alternative<float Config::*>(field.member) ||
                        std::holds_alternative<double Config::*>(field.member) ||
                        std::holds_alternative<std::uint64_t Config::*>(field.member) ||
                        std::holds_alternative<Color Config::*>(field.member);
    EXPECT_EQ(number, field.range.low < field.range.high) << field.name;
    EXPECT_EQ(number, !std::string(field.range.reason).empty()) << field.name;
  }
}

TEST(ConfigFields, PresetsAndPublishedChoicesAreSound) {
  for (const Preset kind : {Preset::object, Preset::scene}) {
    EXPECT_EQ(defect(preset(kind)).value_or(""), "");
    EXPECT_EQ(defect(published(kind)).value_or(""), "");
  }
}

TEST(ConfigFields, OpenEndsExcludeTheEnd) {
  const Range low{0, 1, Range::Ends::low_open, ""}, high{0, 1, Range::Ends::high_open, ""};
  EXPECT_FALSE(low.contains(0));
  EXPECT_TRUE(low.contains(1));
  EXPECT_TRUE(high.contains(0));
  EXPECT_FALSE(high.contains(1));
  EXPECT_FALSE(low.contains(std::nan("")));
  EXPECT_THAT(low.text(), Names(0, 1));
  EXPECT_THAT(high.text(), Names(0, 1));
  EXPECT_NE(low.text(), high.text());
}

// --- Files ----------------------------------------------------------------------------------

/// A valid configuration that differs from the default in every field.
Config random_config(std::mt19937& random) {
  Config config;
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (const ConfigField& field : config_fields()) {
    const double high = std::min(field.range.high, 1e6);
    std::visit(
        [&](auto member) {
          auto& value = config.*member;
          using Value = std::remove_reference_t<decltype(value)>;
          if constexpr (std::is_same_v<Value, Color>)
            for (float& channel : value) channel = float(uniform(0, 0.99));
          else if constexpr (std::is_same_v<Value, float>)
            value = float(uniform(field.range.low + 1e-6, high * (1 - 1e-6)));
          else if constexpr (std::is_same_v<Value, std::uint64_t>)
            value = (std::uint64_t(random()) << 32 | random()) | 1;
          else if constexpr (std::is_same_v<Value, int>)
            value += 1;
          else if constexpr (std::is_same_v<Value, bool>)
            value = !value;
          else
            value = Value(1);
        },
        field.member);
  }
  config.coarse_level = 1;
  config.near = config.far / 2;
  return config;
}

template <class Value>
auto bytes_of(const Value& value) {
  return std::bit_cast<std::array<std::byte, sizeof value>>(value);
}

void expect_equal(const Config& a, const Config& b) {
  for (const ConfigField& field : config_fields())
    std::visit(
        [&](auto member) { EXPECT_EQ(bytes_of(a.*member), bytes_of(b.*member)) << field.name; },
        field.member);
}

TEST(ConfigFile, ComesBackToTheBit) {
  std::mt19937 random(20261121);
  for (int round = 0; round < 200; ++round) {
    const Config config = random_config(random);
    ASSERT_EQ(defect(config).value_or(""), "");
    for (const ConfigField& field : config_fields())
      EXPECT_NE(value_text(config, field), value_text(Config{}, field)) << field.name;
    expect_equal(read(config_to_json(config)), config);
    if (HasFailure()) FAIL() << config_to_json(config);
  }
}

TEST(ConfigFile, WhatItDoesNotNameIsThePresetsOwn) {
  const Config given = read(R"({"preset": "scene", "steps": 2500, "seed": 18446744073709551615})");
  Config expected = preset(Preset::scene);
  expected.steps = 2500;
  expected.seed = 18446744073709551615u;
  expect_equal(given, expected);
  expect_equal(read("{}"), preset(Preset::object));
  expect_equal(read("{}", {.preset = Preset::scene}), preset(Preset::scene));
  expect_equal(read(R"({"preset": "object"})", {.preset = Preset::scene}), preset(Preset::object));
  expect_equal(read("{}", {.preset = Preset::object, .published = true}),
               published(Preset::object));
}

TEST(ConfigFile, WritesFloatsAsPeopleDo) {
  const std::string text = config_to_json(Config{});
  EXPECT_THAT(text, StartsWith("{\n  \"preset\": \"object\",\n  \"steps\": 10000,\n"));
  EXPECT_THAT(text, HasSubstr("\"l1_weight\": 0.8,\n"));
  EXPECT_THAT(text, HasSubstr("\"lift_keeps_opacity\": true,\n"));
  EXPECT_THAT(text, HasSubstr("\"background\": [1, 1, 1]\n}\n"));
}

TEST(ConfigFile, SaysWhatIsWrong) {
  const auto expect = [](const std::string& text, const auto&... values) {
    EXPECT_THAT(refusal(text), ErrorAt("run.json", values...)) << text;
  };
  EXPECT_THAT(refusal("{"), ErrorIn("run.json"));
  expect("[]");
  expect(R"({"step": 5})", "step", "steps");
  expect(R"({"mlp_rat": 5})", "mlp_rate");
  expect(R"({"mlp_rat": 5, "step": 5})", "mlp_rate", "step", "steps");
  EXPECT_THAT(refusal(R"({"steps": 5, "steps": 6})"), ErrorIn("run.json", "steps"));
  expect(R"({"steps": "many"})", "steps");
  expect(R"({"steps": 2.5})", "steps", 2.5);
  expect(R"({"steps": 0})", "steps", 0, 1, 10000000);
  expect(R"({"steps": 1e300})", "steps", "1e+300");
  expect(R"({"steps": -1e300})", "steps", "-1e+300");
  expect(R"({"triangles": 4000001})", "triangles", 4000001, 4000000);
  expect(R"({"seed": -1})", "seed");
  expect(R"({"baseline": 1})", "baseline");
  expect(R"({"beta1": 1})", "beta1", 1);
  expect(R"({"lift_at": 1.5})", "lift_at", 1.5, 0, 1);
  expect(R"({"far": 1e300})", "far");
  expect(R"({"background": [1, 1]})", "background");
  expect(R"({"background": [1, 1, 2]})", "background", "[1, 1, 2]");
  expect(R"({"background": [1, 1, "x"]})", "background[2]");
  expect(R"({"preset": "objekt"})", "preset", "objekt", "object", "scene");
  expect(R"({"max_level": 8})", "max_level", 8, 7);
  expect(R"({"min_level": 4, "max_level": 3})", "min_level", 4, "max_level", 3);
  expect(R"({"coarse_level": 3})", "coarse_level", 3, "min_level", 2);
  expect(R"({"near": 10})", "near", 10, "far");
  expect(R"({"l1_weight": 0, "ssim_weight": 0})", "l1_weight");
}

TEST(ConfigFile, AMissingOneIsNamed) {
  EXPECT_THAT(error_of([] { read_config(open_existing("nowhere/run.json")); }),
              ErrorAt("nowhere/run.json", "nowhere"));
}

TEST(ConfigReference, HasEveryFieldWithItsDefault) {
  const std::string text = config_reference();
  const Config object = preset(Preset::object);
  for (const ConfigField& field : config_fields())
    EXPECT_THAT(text, HasSubstr(std::string(field.name) + ": " + value_text(object, field)));
}

}  // namespace config_test
}  // namespace tureen::trainer
