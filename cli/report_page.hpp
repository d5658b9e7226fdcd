// The report page: results as one HTML file, which opens without a network. Its sources are
// web/report/; this file puts them and the results together.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tureen::cli {

/// One result on the page.
struct ReportResult {
  std::string file;  // which it was read from; images lie beside it
  std::string kind;  // bench, tradeoff, training, eval or measurements: `kinds` in report.js
  std::string json;  // what a command wrote, valid JSON; of a training, the list of its log's lines
};

/// The page, to be written to `page`: addresses of images are relative to its folder.
std::string report_page(std::span<const ReportResult> results, const std::filesystem::path& page);

/// What `-o FOLDER` writes for a result of this kind: FOLDER/KIND.json and FOLDER/report.html.
std::vector<std::filesystem::path> result_files(const std::filesystem::path& folder,
                                                const std::string& kind);

/// Writes both, each complete or not at all, and the folder. Throws OutputError.
void write_result(const std::filesystem::path& folder, const std::string& kind,
                  const std::string& json);

}  // namespace tureen::cli
