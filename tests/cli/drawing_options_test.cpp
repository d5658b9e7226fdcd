#include "cli/options/drawing_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.hpp"
#include "tests/support/errors.hpp"

namespace tureen::cli {
namespace drawing_options_test {

PlanPreferences parsed(std::vector<std::string> arguments) {
  CommandLine line("program", "");
  Command program = line.program();
  DrawingOptions options;
  add_drawing_options(program, options);
  line.parse(std::move(arguments));
  return options.plan;
}

TEST(DrawingOptions, WhatIsToBeKeptIsNotSkipped) {
  EXPECT_EQ(parsed({}).specialisations, SpecialisationSet::all());
  EXPECT_EQ(parsed({"--keep", "background,alpha-test"}).specialisations,
            SpecialisationSet::all()
                .without(Specialisation::background)
                .without(Specialisation::alpha_test));
  EXPECT_TRUE(parsed({"--keep", "background"}).specialise);
  EXPECT_FALSE(parsed({"--no-specialise"}).specialise);
  EXPECT_THROW(parsed({"--no-specialise", "--keep", "background"}), UsageError);
}

TEST(DrawingOptions, TheShadingStageIsFragmentUnlessComputeIsAskedFor) {
  EXPECT_EQ(parsed({}).shading_stage, ShadingStage::fragment);
  EXPECT_EQ(parsed({"--shading", "fragment"}).shading_stage, ShadingStage::fragment);
  EXPECT_EQ(parsed({"--shading", "compute"}).shading_stage, ShadingStage::compute);
  EXPECT_THROW(parsed({"--shading", "vertex"}), UsageError);
}

TEST(DrawingOptions, AnUnknownNameIsRefusedWithTheNearest) {
  EXPECT_THAT(test::error_of<UsageError>([] {
                parsed({"--keep", "alpha-tset"});
              }),
              test::ErrorAt("", "alpha-tset", "alpha-test"));
}

}  // namespace drawing_options_test
}  // namespace tureen::cli
