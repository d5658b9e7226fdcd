// What tests/bench/reproduce.sh leaves of what it measured. Of each measurement, by its NAME:
//   NAME.run.json   {"command", "date", "commit", "cpu", "cores"}; written when it was done
//   NAME.txt        what it printed; a table in Markdown, or JSON
//   NAME/           the files it wrote, where it wrote any; NAME/table.md is its table then
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

// Files that are not there, or no JSON, are thrown as InputError.

namespace tureen::test {

/// Keys in the order in which they were written.
using Json = nlohmann::ordered_json;

class Measurements {
 public:
  /// Those of a folder that are named; an older run may have left others.
  Measurements(std::filesystem::path folder, std::vector<std::string> names);

  /// In alphabetical order.
  const std::vector<std::string>& names() const { return names_; }
  /// Those whose name begins so.
  std::vector<std::string> beginning_with(const std::string& prefix) const;

  struct Run {
    std::string command, date, commit, cpu;
    int cores = 0;
  };
  Run run(const std::string& name) const;

  std::string text(const std::string& name) const;
  /// What it printed, as JSON.
  Json printed(const std::string& name) const;

  std::filesystem::path file(const std::string& name, const std::string& path) const;
  std::string text_of(const std::string& name, const std::string& path) const;
  Json json(const std::string& name, const std::string& path) const;

 private:
  std::filesystem::path folder_;
  std::vector<std::string> names_;
};

}  // namespace tureen::test
