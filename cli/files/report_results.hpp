// Reads results for `tureen report`: JSON from any command, recognised by its content.
#pragma once

#include <filesystem>
#include <vector>

#include "jobs/report/report_page.hpp"

namespace tureen::cli {

using results::ReportResult;

/// The results in a file or folder. A download of bench.html may have several; every other file has
/// one, with the file's JSON. For a folder, reads all .json and .jsonl files in it and below it,
/// sorted by path; skips valid JSON of another kind. Throws InputError, with the file and the place
/// in it, if a file is not a result or lacks a member that the page needs, or if a folder has no
/// results.
std::vector<ReportResult> read_results(const std::filesystem::path& path);

}  // namespace tureen::cli
