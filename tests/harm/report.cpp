// Puts what the tests of hostile input and faults measured, and what fuzzers said at their end,
// into docs/hostile.md: tables between two marks, everything else in the page stays as people wrote
// it.
//
//   harm_report MEASURED FUZZED SECONDS PAGE
//
// MEASURED is the folder that TUREEN_MEASURED named; FUZZED holds what tests/fuzz/run.sh printed,
// as TARGET.log, of so many SECONDS each.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "soup/error.hpp"
#include "support/measured.hpp"

namespace tureen::test {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

bool begins(const Measured& measured, const char* with) {
  return measured.name.rfind(with, 0) == 0;
}

std::string counts(const Json& ended) {
  return fmt::format("{} / {}", ended.at("read").get<std::uint64_t>(),
                     ended.at("refused").get<std::uint64_t>());
}

std::string damage_table(const std::vector<Measured>& all) {
  std::string text =
      "| reader | fixtures | cut short: read / refused | bits flipped: read / refused | "
      "most memory | slowest read |\n|---|---|---|---|---|---|\n";
  for (const Measured& row : all)
    if (begins(row, "damage-"))
      text += fmt::format("| `{}` | {} | {} | {} | {:.0f} kB | {:.0f} ms |\n",
                          row.json.at("reader").get<std::string>(),
                          row.json.at("fixtures").get<int>(), counts(row.json.at("cut")),
                          counts(row.json.at("flipped")), row.json.at("bytes").get<double>() / 1e3,
                          1e3 * row.json.at("seconds").get<double>());
  return text;
}

/// The digits behind the last `label` in what a fuzzer printed.
std::uint64_t number_behind(const std::string& log, const std::string& label,
                            const fs::path& file) {
  std::size_t at = log.rfind(label);
  if (at != std::string::npos) at = log.find_first_not_of(' ', at + label.size());
  if (at == std::string::npos || log[at] < '0' || log[at] > '9')
    throw InputError({file.string(), {}, {}}, "no number stands behind '" + label + "'");
  return std::stoull(log.substr(at, 19));
}

std::vector<fs::path> logs_in(const fs::path& folder) {
  std::vector<fs::path> logs;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".log") logs.push_back(entry.path());
  std::sort(logs.begin(), logs.end());
  return logs;
}

/// What the tests of faults leave: each output under each signal, and trainings that went on.
constexpr const char* faults[] = {"signal-export-SIGINT",
                                  "signal-export-SIGKILL",
                                  "signal-out.glb-SIGINT",
                                  "signal-out.glb-SIGKILL",
                                  "signal-train-SIGINT",
                                  "signal-train-SIGKILL",
                                  "resume"};

/// A part that did not run is no row that is missing: every reader that was damaged was fuzzed, and
/// the reverse, and every writer was interrupted.
void require_all(const std::vector<Measured>& all, const std::vector<fs::path>& logs,
                 const fs::path& folder) {
  std::vector<std::string> damaged, fuzzed;
  for (const Measured& row : all)
    if (begins(row, "damage-")) damaged.push_back(row.json.at("reader"));
  for (const fs::path& log : logs) fuzzed.push_back(log.stem().string());
  std::sort(damaged.begin(), damaged.end());
  if (damaged.empty() || damaged != fuzzed)
    throw InputError({folder.string(), {}, {}},
                     fmt::format("{} readers were damaged, {} fuzzed: they should be the same",
                                 damaged.size(), fuzzed.size()));
  for (const char* name : faults)
    if (std::none_of(all.begin(), all.end(), [&](const Measured& row) { return row.name == name; }))
      throw InputError({folder.string(), {}, {}},
                       fmt::format("the tests of faults have left no {}.json there", name));
}

std::string fuzz_table(const std::vector<fs::path>& logs) {
  std::string text =
      "| reader | executions | a second | edges seen | inputs kept | most memory |\n"
      "|---|---|---|---|---|---|\n";
  for (const fs::path& path : logs) {
    std::ifstream file(path);
    const std::string log((std::istreambuf_iterator<char>(file)), {});
    const auto number = [&](const char* label) { return number_behind(log, label, path); };
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} MB |\n", path.stem().string(),
                        number("stat::number_of_executed_units:"),
                        number("stat::average_exec_per_sec:"), number("cov:"), number("corp:"),
                        number("stat::peak_rss_mb:"));
  }
  return text;
}

std::string fault_table(const std::vector<Measured>& all) {
  std::string text =
      "| what | signal | sent | cut short | the old one, whole | the new one, whole |\n"
      "|---|---|---|---|---|---|\n";
  for (const Measured& row : all)
    if (begins(row, "signal-"))
      text +=
          fmt::format("| {} | {} | {} | {} | {} | {} |\n", row.json.at("what").get<std::string>(),
                      row.json.at("signal").get<std::string>(), row.json.at("sent").get<int>(),
                      row.json.at("cut_short").get<int>(), row.json.at("old").get<int>(),
                      row.json.at("new").get<int>());
  for (const Measured& row : all)
    if (row.name == "resume")
      text += fmt::format(
          "\nTrainings of {} steps were sent {} signals, of which {} cut a run short, {} of them "
          "SIGKILL while a file was half written. Runs were resumed by `--resume` {} times; {} of "
          "those came to their end, each in the very same file as a run that was left alone, and "
          "the others were cut short again.\n",
          row.json.at("steps").get<int>(), row.json.at("sent").get<int>(),
          row.json.at("cut_short").get<int>(), row.json.at("half_written").get<int>(),
          row.json.at("resumed").get<int>(), row.json.at("resumed_to_end").get<int>());
  return text;
}

}  // namespace

}  // namespace tureen::test

int main(int argc, char** argv) {
  using namespace tureen::test;
  if (argc != 5) {
    std::fprintf(stderr, "usage: harm_report MEASURED FUZZED SECONDS PAGE\n");
    return 2;
  }
  try {
    const std::vector<Measured> all = read_measured(argv[1]);
    const std::vector<std::filesystem::path> logs = logs_in(argv[2]);
    require_all(all, logs, argv[1]);
    write_between(argv[4], Marks("./dev harm"),
                  fmt::format("\nBy `./dev harm {}`.\n", argv[3]) + "\n### Damage\n\n" +
                      damage_table(all) + "\n### Fuzzing\n\n" + fuzz_table(logs) +
                      "\n### Signals\n\n" + fault_table(all) + "\n");
    std::fprintf(stderr, "wrote %s\n", argv[4]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "harm_report: %s\n", error.what());
    return 1;
  }
}
