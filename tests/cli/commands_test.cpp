// Rules for the options of all subcommands.
#include "cli/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

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

/// The options in the --help of a command, with "--".
std::set<std::string> options_of(const std::string& command) {
  CommandLine line("tureen", "");
  Command program = line.program();
  program.add_text_flag(
      "--version", [] { return std::string(); }, "");
  add_commands(program, {});
  std::vector<std::string> arguments{"--help"};
  if (!command.empty()) arguments.insert(arguments.begin(), command);
  testing::internal::CaptureStdout();
  line.parse(arguments)();
  std::istringstream help(testing::internal::GetCapturedStdout());
  std::set<std::string> options;
  for (std::string text; std::getline(help, text);) {
    // "  -o,--output FOLDER": the name, before the description.
    const std::size_t begin = text.find_first_not_of(' ');
    if (begin == std::string::npos || begin == 0 || text[begin] != '-') continue;
    static const std::regex name("--[a-z][a-z0-9-]*");
    const std::string head = text.substr(begin, text.find(' ', begin) - begin);
    for (std::sregex_iterator at(head.begin(), head.end(), name), end; at != end; ++at)
      options.insert(at->str());
  }
  return options;
}

const std::vector<std::string> commands{"render", "trace",   "train",    "cameras",
                                        "info",   "convert", "compare",  "eval",
                                        "bench",  "view",    "tradeoff", "report"};

/// The literals of a C++ source, without its comments.
std::vector<std::string> literals_of(const std::string& text) {
  std::vector<std::string> literals;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text.compare(at, 2, "//") == 0) {
      at = std::min(text.find('\n', at), text.size());
    } else if (text.compare(at, 3, "R\"(") == 0) {
      const std::size_t end = text.find(")\"", at);
      literals.push_back(text.substr(at + 3, end - at - 3));
      at = end + 1;
    } else if (text[at] == '\'' && text.size() > at + 2) {  // "'\"'", but not 10'000
      if (text[at + 1] == '\\')
        at = text.find('\'', at + 3);
      else if (text[at + 2] == '\'')
        at += 2;
    } else if (text[at] == '"') {
      std::string literal;
      for (++at; at < text.size() && text[at] != '"'; ++at) {
        if (text[at] == '\\') literal += text[at++];
        literal += text[at];
      }
      literals.push_back(literal);
    }
  }
  return literals;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The literals of a TypeScript source, without its comments.
std::vector<std::string> script_literals_of(const std::string& text) {
  static const std::regex piece(
      R"(//[^\n]*|/\*[^*]*(?:\*(?!/)[^*]*)*\*/|(['"`])((?:(?!\1)[^\\]|\\.)*)\1)");
  std::vector<std::string> literals;
  for (std::sregex_iterator at(text.begin(), text.end(), piece), end; at != end; ++at)
    literals.push_back(at->str(2));
  return literals;
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern, int group) {
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at)
    found.push_back(at->str(std::size_t(group)));
  return found;
}

const std::filesystem::path root = TUREEN_SOURCE_DIR;
const std::regex option_pattern("--[a-z][a-z0-9-]*[a-z0-9]"), command_pattern("tureen ([a-z]+)");

TEST(Messages, NameOptionsAndCommandsThatExist) {
  std::set<std::string> known = options_of("");
  for (const std::string& command : commands)
    if (command != "view") known.merge(options_of(command));
  // tureen view starts another program.
  for (const std::string& literal : literals_of(text_of(root / "viewer/main.cpp")))
    if (literal.starts_with("--")) known.insert(literal.substr(0, literal.find_first_of(" ,")));
  // An option of REdiSplats' program, and an earlier name of --images.
  known.insert({"--quant", "--pictures"});
  known.insert({"--no-install-recommends", "--pdeathsig"});  // of apt-get and setpriv
  // Formats of results that are named after their source.
  const std::set<std::string> formats{"web", "measurements"};
  std::size_t checked = 0;
  known.insert("--sheet");  // a variable of the page's style
  for (const char* module : {"base", "image", "scene", "camera", "formats", "splatting", "runtime",
                             "trainer", "jobs", "cli", "viewer", "web/bench", "web/common",
                             "web/engine", "web/page", "web/report", "web/viewer"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / module)) {
      const std::string extension = entry.path().extension().string();
      const bool is_page = extension == ".html", is_script = extension == ".ts";
      if (extension != ".cpp" && extension != ".hpp" && !is_page && !is_script) continue;
      if (entry.path().filename() == "colmap_stages.cpp") continue;  // the options of COLMAP
      const std::string text = text_of(entry.path());
      for (const std::string& literal : is_page     ? std::vector<std::string>{text}
                                        : is_script ? script_literals_of(text)
                                                    : literals_of(text)) {
        for (const std::string& option : matches(literal, option_pattern, 0)) {
          EXPECT_TRUE(known.contains(option)) << entry.path() << ": " << option;
          ++checked;
        }
        for (const std::string& command : matches(literal, command_pattern, 1))
          EXPECT_TRUE(formats.contains(command) || std::ranges::count(commands, command) > 0)
              << entry.path() << ": tureen " << command;
      }
    }
  EXPECT_GT(checked, 300u);  // 450 when written: the literals are found
}

TEST(Messages, OfDocumentsNameOptionsOfTheirCommand) {
  std::vector<std::filesystem::path> pages{root / "README.md"};
  for (const auto& entry : std::filesystem::directory_iterator(root / "docs"))
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  std::map<std::string, std::set<std::string>> options;
  for (const std::string& command : commands)
    if (command != "view") options[command] = options_of(command);
  std::size_t checked = 0;
  for (const auto& page : pages) {
    std::istringstream lines(text_of(page));
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("tureen ")) continue;
      line.erase(std::min(line.find(" #"), line.size()));
      const std::string command = line.substr(7, line.find(' ', 7) - 7);
      if (!options.contains(command)) continue;
      for (const std::string& option : matches(line, option_pattern, 0)) {
        EXPECT_TRUE(options[command].contains(option)) << page << ": " << line;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 30u);
}

TEST(Messages, OfReadersHaveNoAdviceForTheCommandLine) {
  // A remark is stored with the scene, and shown by window and page. The programs add their option.
  std::size_t checked = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "formats")) {
    if (!entry.path().stem().string().ends_with("_remarks")) continue;
    for (const std::string& literal : literals_of(text_of(entry.path()))) {
      EXPECT_THAT(matches(literal, option_pattern, 0), testing::IsEmpty()) << entry.path();
      ++checked;
    }
  }
  EXPECT_GT(checked, 50u);
}

}  // namespace commands_test
}  // namespace tureen::cli
