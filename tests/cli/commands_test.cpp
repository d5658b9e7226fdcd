// Rules for the options of all subcommands.
#include "cli/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/errors.hpp"

namespace tureen::cli {
namespace commands_test {

TEST(Commands, NoOptionThatTakesANumberTakesNan) {
  const std::pair<const char*, const char*> options[] = {{"bench", "--seconds"},
                                                         {"bench", "--fail-slower"},
                                                         {"bench", "--scale"},
                                                         {"compare", "--tolerance"},
                                                         {"compare", "--pixel-tolerance"},
                                                         {"convert", "--max-error"},
                                                         {"render", "--fov"},
                                                         {"render", "--fps"},
                                                         {"render", "--turntable"},
                                                         {"tradeoff", "--scale"},
                                                         {"tradeoff", "--least-psnr"},
                                                         {"tradeoff", "--most-mismatch"},
                                                         {"train", "--scale"}};
  for (const auto& [command, option] : options)
    for (const char* nan : {"nan", "-nan", "NaN", "nan(7)"}) {
      CommandLine line("tureen", "");
      Command program = line.program();
      add_commands(program, {});
      const std::string argument = std::string(option) + "=" + nan;
      EXPECT_THAT(test::error_of<UsageError>([&] {
                    line.parse({command, argument});
                  }),
                  test::ErrorAt("", option, nan));
    }
}

}  // namespace commands_test
}  // namespace tureen::cli
