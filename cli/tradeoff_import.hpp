// `tureen tradeoff --import`: one panel over several scenes, of what earlier runs measured.
#pragma once

#include <string>
#include <vector>

#include "cli/exit_code.hpp"

namespace tureen::cli {

struct TradeoffImport {
  std::vector<std::string> files;  // tradeoff.json of a scene each
  std::string folder;              // for scenes.html, .csv, .json and the plots; empty: none
  bool json = false;
  std::vector<std::string> arguments;  // of the program, as typed
};

/// Reads all files before it says or writes anything. Throws UsageError where there are fewer than
/// two, what read_tradeoff() and join() throw, and OutputError.
ExitCode import_tradeoffs(const TradeoffImport& import);

}  // namespace tureen::cli
