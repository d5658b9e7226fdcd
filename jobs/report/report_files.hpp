// The files of the report page, embedded by the build: report.html, report.css and report.js from
// web/report/, palette.css from web/page/style/, and chart.min.js if chart.js is installed.
#pragma once

#include <string_view>

namespace tureen::results::report_files {

/// Empty if there is no such file.
std::string_view text(std::string_view name);

}  // namespace tureen::results::report_files
