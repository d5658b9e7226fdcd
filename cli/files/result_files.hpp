// The files of `-o FOLDER`: a result as JSON, and the report page that shows it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tureen::cli {

/// FOLDER/KIND.json and FOLDER/report.html, for a result of this kind (ReportResult::kind).
std::vector<std::filesystem::path> result_files(const std::filesystem::path& folder,
                                                const std::string& kind);

/// Writes both, each completely or not at all, and creates the folder. Throws OutputError.
void write_result(const std::filesystem::path& folder, const std::string& kind,
                  const std::string& json);

}  // namespace tureen::cli
