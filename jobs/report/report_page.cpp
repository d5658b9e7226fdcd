#include "jobs/report/report_page.hpp"

#include <cctype>
#include <string_view>

#include "base/json/json_text.hpp"
#include "jobs/report/report_files.hpp"

namespace tureen::results {

namespace {

namespace fs = std::filesystem;

/// The path as an address: all bytes except ASCII letters, digits and -_.~/ are percent-encoded.
std::string address(const std::string& path) {
  constexpr const char* hex = "0123456789ABCDEF";
  std::string result;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 0x80 && std::isalnum(byte)) ||
        std::string_view("-_.~/").find(c) != std::string::npos)
      result += c;
    else
      result += {'%', hex[byte >> 4], hex[byte & 15]};
  }
  return result;
}

/// The address of the folder of `file` relative to the folder of `page`, with a '/' at its end; ""
/// if they are equal.
std::string folder_address(const fs::path& file, const fs::path& page) {
  const auto folder = [](const fs::path& path) {
    return fs::weakly_canonical(fs::absolute(path).parent_path());
  };
  const std::string relative = folder(file).lexically_relative(folder(page)).generic_string();
  return relative == "." ? "" : address(relative) + "/";
}

/// JSON that cannot end a <script> element. In JSON, '<' occurs only in texts.
std::string escaped(std::string_view json) {
  std::string result;
  for (const char c : json) {
    if (c == '<')
      result += "\\u003c";
    else
      result += c;
  }
  return result;
}

/// Text as a JSON string.
std::string quoted(const std::string& text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string data_of(std::span<const ReportResult> results, const fs::path& page) {
  std::string data;
  for (const ReportResult& each : results)
    data += (data.empty() ? "{\"file\":" : ",\n{\"file\":") + quoted(each.file) +
            ",\"folder\":" + quoted(folder_address(each.file, page)) +
            ",\"kind\":" + quoted(each.kind) + ",\"data\":" + each.json + "}";
  return escaped("[" + data + "]");
}

}  // namespace

std::string report_page(std::span<const ReportResult> results, const fs::path& page) {
  // Elements of report.html, in their order, with their replacements.
  const std::pair<std::string_view, std::string> parts[] = {
      {R"(<link rel="stylesheet" href="../page/style/palette.css">)",
       "<style>\n" + std::string(report_files::text("palette.css"))},
      {R"(<link rel="stylesheet" href="report.css">)",
       std::string(report_files::text("report.css")) + "</style>"},
      {R"(<script type="application/json" id="data">[]</script>)",
       "<script type=\"application/json\" id=\"data\">" + data_of(results, page) + "</script>"},
      {R"(<script src="chart.min.js"></script>)",
       "<script>\n" + std::string(report_files::text("chart.min.js")) + "</script>"},
      {R"(<script src="report.js"></script>)",
       "<script>\n" + std::string(report_files::text("report.js")) + "</script>"}};
  std::string_view rest = report_files::text("report.html");
  std::string html;
  for (const auto& [element, replacement] : parts) {
    const std::size_t at = rest.find(element);
    html.append(rest.substr(0, at)).append(replacement);
    rest.remove_prefix(at + element.size());
  }
  return html.append(rest);
}

}  // namespace tureen::results
