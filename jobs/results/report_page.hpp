// The report page: results as one HTML file, which opens without a network. Its sources are
// web/report/; this file puts them and the results together.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tureen::results {

/// One result on the page.
struct ReportResult {
  std::string file;  // which it was read from; images lie beside it
  std::string kind;  // bench, tradeoff, training, eval or measurements: `kinds` in report.js
  std::string json;  // what a command wrote, valid JSON; of a training, the list of its log's lines
};

/// The page, to be written to `page`: addresses of images are relative to its folder.
std::string report_page(std::span<const ReportResult> results, const std::filesystem::path& page);

}  // namespace tureen::results
