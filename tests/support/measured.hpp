// What tests measure, on its way into a page of docs/: a test leaves it as a file, and a program of
// reports (`./dev numerics`, `./dev harm`) writes those of a run between two marks of the page.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tureen::test {

/// Writes `measured` as NAME.json into the folder that TUREEN_MEASURED names; without it, nothing.
/// Fails the test that runs where that cannot be.
void leave_measured(const std::string& name, const nlohmann::json& measured);

struct Measured {
  std::string name;  // the file's, without its extension
  nlohmann::json json;
};

/// What tests left in `folder`, by name. Throws InputError where that is nothing, or no JSON.
std::vector<Measured> read_measured(const std::filesystem::path& folder);

/// Where a page holds what `command` measured: from the first mark to the second.
struct Marks {
  explicit Marks(const std::string& command);
  std::string begin, end;
};

/// Replaces what stands between the marks of `page`, and nothing else of it. Throws InputError
/// where the page does not have them both, or another's between them; OutputError where it cannot
/// be written.
void write_between(const std::filesystem::path& page, const Marks& marks, const std::string& text);

/// `text` as a cell of a table in Markdown.
std::string table_cell(std::string text);

}  // namespace tureen::test
