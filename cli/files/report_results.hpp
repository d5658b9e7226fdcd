// Reads what `tureen report` shows: the JSON of any command, recognised by its content.
#pragma once

#include <filesystem>
#include <vector>

#include "jobs/results/report_page.hpp"

namespace tureen::cli {

using results::ReportResult;

/// The results of a file: several from a download of bench.html, else one, with the file's JSON.
/// Of a folder, the results in all its .json and .jsonl files, also in folders below it, by name;
/// valid JSON of another kind is skipped there. Throws InputError with the file, and the place in
/// it, where it is no result or lacks a member that the page needs, or where a folder holds none.
std::vector<ReportResult> read_results(const std::filesystem::path& path);

}  // namespace tureen::cli
