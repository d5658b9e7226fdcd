// `tureen report`: results as one page, in the browser or in a file.
#include <cstdlib>
#include <memory>
#include <system_error>

#include "base/error.hpp"
#include "base/extension.hpp"
#include "base/output.hpp"
#include "base/platform/process.hpp"
#include "cli/commands.hpp"
#include "cli/files/report_results.hpp"
#include "cli/options/output_argument.hpp"
#include "cli/report.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  std::vector<std::string> inputs;
  std::string output;  // empty: the page opens in the browser
};

const char* set_variable(const char* name) {
  const char* value = std::getenv(name);
  return value && *value ? value : nullptr;
}

/// All pages without -o have the same path, so that the cache keeps only one.
fs::path page_in_cache() {
  fs::path folder;
  if (const char* cache = set_variable("XDG_CACHE_HOME"))
    folder = cache;
  else if (const char* home = set_variable("HOME"))
    folder = fs::path(home) / ".cache";
  else
    throw UsageError("XDG_CACHE_HOME and HOME are not set: name the page with -o OUT.html");
  make_folder(folder / "tureen");
  return fs::absolute(folder / "tureen/report.html");
}

/// Returns whether the browser opened the page.
bool open_in_browser(const std::string& page) {
#ifdef __APPLE__
  const char* program = "open";
#else
  // Without a display, xdg-open would start a text browser in the terminal.
  if (!set_variable("DISPLAY") && !set_variable("WAYLAND_DISPLAY")) return false;
  const char* program = "xdg-open";
#endif
  try {
    return Process(program, {page}, {}).wait() == 0;
  } catch (const std::system_error&) {
    return false;
  }
}

ExitCode report(const ReportOptions& options) {
  const bool opens = options.output.empty();
  if (!opens && extension_of(options.output) != ".html")
    throw UsageError("'" + options.output + "' does not end in .html; a report is an HTML page");
  const fs::path page = opens ? page_in_cache() : fs::path(options.output);
  for (const std::string& input : options.inputs)
    if (!fs::is_directory(input)) require_not_input(page, input);
  require_writable_file(page);
  std::vector<ReportResult> results;
  for (const std::string& input : options.inputs)
    for (ReportResult& each : read_results(input)) results.push_back(std::move(each));
  write_file(page, results::report_page(results, page));
  if (!opens)
    say("wrote " + page.string());
  else if (!open_in_browser(page.string()))
    print_text(page.string() + "\n");
  return ExitCode::done;
}

}  // namespace

void add_report(Command& program) {
  auto options = std::make_shared<ReportOptions>();
  Command command =
      program.add_command("report", "Show results as a page of tables, plots and images");
  command.footer(
      R"(Reads results from bench, tradeoff and eval (--json or -o), logs from train, files that the
page bench.html saved, and measurements from ./dev. Several results of one kind appear side by
side; tradeoff results of several scenes share one table with means. The page needs no network.
It links to images and does not copy them.

Examples:
  tureen report timed/bench.json                opens in a browser, or prints the page's path
  tureen report phone.json laptop.json          frame times by device
  tureen report lego.jsonl chair.jsonl -o trainings.html
  tureen report lego/tradeoff.json chair/tradeoff.json       means over scenes
  tureen report results                         all results in a folder

Exit codes: 0 done, 2 wrong usage, 3 a result cannot be read, 5 the page cannot be written.)");
  command.add_option("FILE", options->inputs, "JSON results, training logs, or folders with them")
      .required();
  command.add_option("-o,--output OUT.html", options->output,
                     "page to write. By default, writes report.html to the user's cache folder and "
                     "opens it in a browser");
  command.does([options] { return report(*options); });
}

}  // namespace tureen::cli
