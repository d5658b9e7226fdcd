// The report page: results as one HTML file, which opens without a network. Its sources are
// web/report/; this file combines them with the results.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace tureen::results {

/// One result on the page.
struct ReportResult {
  std::string file;  // source of the result; images are beside it
  std::string kind;  // bench, tradeoff, training, eval or measurements: `kinds` in report.js
  std::string json;  // valid JSON from a command; for training, the list of the log's lines
};

/// The HTML of the page. `page`: its path; addresses of images are relative to its folder.
std::string report_page(std::span<const ReportResult> results, const std::filesystem::path& page);

}  // namespace tureen::results
