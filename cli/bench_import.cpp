#include "cli/bench_import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "cli/bench_csv.hpp"
#include "cli/bench_devices.hpp"
#include "cli/bench_table.hpp"
#include "cli/gnuplot.hpp"
#include "cli/web_bench.hpp"
#include "formats/existing_path.hpp"
#include "formats/output.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

/// Of the files' names without their ends, or as typed where two are the same then.
std::vector<std::string> device_names(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  for (const std::string& file : files) names.push_back(fs::path(file).stem().string());
  const std::set<std::string> distinct(names.begin(), names.end());
  return distinct.size() == names.size() ? names : files;
}

std::vector<DeviceBench> read_devices(const std::vector<std::string>& files) {
  std::vector<DeviceBench> devices;
  for (const std::string& name : device_names(files)) {
    const std::string& file = files[devices.size()];
    require_there(file);
    Input input = Input::open(file);
    devices.push_back({name, read_web_bench(input)});
  }
  return devices;
}

void write_and_say(const fs::path& path, const std::string& text) {
  write_file(path, text);
  say("wrote " + path.string());
}

/// Folders for the reports of each result: of its device and its scene, and a number where that is
/// not enough.
class Subfolders {
 public:
  std::string operator()(const std::string& parent, const std::string& device,
                         const std::string& scene) {
    if (parent.empty()) return "";
    const std::string plain = plot_identifier(device + " " + scene);
    std::string name = plain;
    for (int i = 2; !taken_.insert(name).second; ++i) name = fmt::format("{}-{}", plain, i);
    return (fs::path(parent) / name).string();
  }

 private:
  std::set<std::string> taken_;
};

void report_several(const BenchImport& import, const std::vector<DeviceBench>& devices) {
  const BenchReportOptions& reports = import.reports;
  std::vector<BenchResult> all;
  Subfolders folders, plot_folders;
  for (const DeviceBench& device : devices)
    for (const BenchResult& result : device.results) {
      BenchReportOptions own;
      own.folder = folders(reports.folder, device.name, result.scene.name);
      own.plots = plot_folders(reports.plots, device.name, result.scene.name);
      prepare_bench_reports(own, import.files);
      report_bench(own, result, {});
      all.push_back(result);
    }
  if (!reports.csv.empty()) write_and_say(reports.csv, bench_csv(all));
  if (reports.folder.empty()) return;
  const fs::path folder = reports.folder;
  write_and_say(folder / "bench.csv", bench_csv(all));
  const DeviceTable table = device_table(devices);
  write_and_say(folder / "devices.md", device_markdown(table));
  write_and_say(folder / "devices.html", device_page(table));
}

void say_result(const BenchResult& result) {
  say(result.scene.name + ", " + result.date + ":");
  say_list("Notes:", result.notes);
  for (const std::string& line : bench_table(result)) say(line);
  say("");
}

}  // namespace

ExitCode import_benches(const BenchImport& import) {
  const std::vector<DeviceBench> devices = read_devices(import.files);
  std::size_t count = 0;
  for (const DeviceBench& device : devices) count += device.results.size();
  if (count > 1 && !import.reports.against.empty())
    throw UsageError(fmt::format(
        "--against compares one scene on one device, and the files hold {} of them", count));
  const std::optional<BenchResult> then = prepare_bench_reports(import.reports, import.files);

  Json all = Json::array();
  for (const DeviceBench& device : devices)
    for (const BenchResult& result : device.results) {
      say_result(result);
      all.push_back(to_json(result));
    }
  if (devices.size() > 1)
    for (const std::string& line : device_lines(device_table(devices))) say(line);
  if (count == 1) return report_bench(import.reports, devices.front().results.front(), then);
  if (import.reports.json) print_json(all);
  report_several(import, devices);
  return ExitCode::done;
}

}  // namespace tureen::cli
