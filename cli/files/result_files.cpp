#include "cli/files/result_files.hpp"

#include "base/output.hpp"
#include "jobs/report/report_page.hpp"

namespace tureen::cli {

namespace fs = std::filesystem;

std::vector<fs::path> result_files(const fs::path& folder, const std::string& kind) {
  return {folder / (kind + ".json"), folder / "report.html"};
}

void write_result(const fs::path& folder, const std::string& kind, const std::string& json) {
  const std::vector<fs::path> files = result_files(folder, kind);
  const results::ReportResult result{files[0].string(), kind, json};
  make_folder(folder);
  write_file(files[0], json);
  write_file(files[1], results::report_page({&result, 1}, files[1]));
}

}  // namespace tureen::cli
