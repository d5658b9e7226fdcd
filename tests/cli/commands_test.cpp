// All subcommands at once: what holds for every option of theirs.
#include "cli/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tureen::cli {
namespace {

TEST(Commands, NoOptionThatTakesANumberTakesNan) {
  CLI::App program;
  Action action;
  add_commands(program, action, {});
  std::vector<std::string> asked;
  for (CLI::App* command : program.get_subcommands([](CLI::App*) { return true; }))
    for (CLI::Option* option : command->get_options()) {
      if (!option->get_type_name().starts_with("FLOAT")) continue;
      asked.push_back(command->get_name() + " " + option->get_name());
      for (const char* nan : {"nan", "-nan", "NaN", "nan(7)"}) {
        option->clear();
        option->add_result(nan);
        EXPECT_THROW(option->run_callback(), CLI::ValidationError) << asked.back() << " " << nan;
      }
    }
  EXPECT_THAT(asked, testing::IsSupersetOf({"bench --seconds", "compare --pixel-tolerance",
                                            "convert --max-error", "render --fov", "render --fps",
                                            "render --turntable", "tradeoff --least-psnr",
                                            "train --scale"}));
}

}  // namespace
}  // namespace tureen::cli
