#include "cli/files/report_results.hpp"

#include <algorithm>

#include "base/existing_path.hpp"
#include "base/extension.hpp"
#include "base/input.hpp"
#include "formats/scene_file.hpp"
#include "jobs/bench/bench_json.hpp"
#include "jobs/bench/json_reading.hpp"
#include "jobs/bench/web_bench.hpp"
#include "jobs/tradeoff/tradeoff_json.hpp"
#include "trainer/common/training_log.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

/// Not a result from Tureen, or a result without data yet. In folders such files are skipped.
struct UnknownResult : InputError {
  using InputError::InputError;
};

void check_tradeoff(const JsonView& root) {
  results::require_format(root, results::tradeoff_format, results::tradeoff_version,
                          "not a result of tureen tradeoff");
  results::scene_of(root["scene"]);
  results::device_of(root["device"]);
  for (const char* name : {"drawing", "antialiasing"}) {
    const JsonView configurations = root[name]["configurations"];
    if (configurations.size() == 0) configurations.fail("is empty");
    results::list(configurations,
                  [](const JsonView& each) { return each["e_render"]["psnr_db"].number(); });
  }
}

void check_eval(const JsonView& root) {
  root["mean"]["psnr_db"].number();
  if (root["views"].size() == 0) root["views"].fail("is empty");
  results::list(root["views"], [](const JsonView& each) {
    each["name"].text();
    return each["psnr_db"].number();
  });
}

void check_measurements(const JsonView& root) {
  results::require_format(root, "tureen measurements", 1, "not measurements");
  root["name"].text();
  const JsonView tables = root["tables"];
  for (const auto& [name, rows] : tables.value().items()) tables[name.c_str()].size();
}

/// The lines of a log as a list, without an incomplete last line.
ReportResult training(const std::string& file, const std::string& text) {
  if (trainer::read_training_log(file).empty())
    throw UnknownResult({file}, "the log has no records yet");
  std::string lines = text.substr(0, text.rfind('\n'));
  std::replace(lines.begin(), lines.end(), '\n', ',');
  return {file, "training", "[" + lines + "]"};
}

std::vector<ReportResult> web_bench(const std::string& file) {
  Input input = Input::open(file);
  std::vector<ReportResult> results;
  for (const BenchResult& each : results::read_web_bench(input))
    results.push_back({file, "bench", json_text(results::to_json(each))});
  return results;
}

std::vector<ReportResult> read_file(const std::string& file) {
  if (fs::is_regular_file(file) && is_scene(file))
    throw UnknownResult({file},
                        "this is a scene; a report takes results of bench, tradeoff, eval or "
                        "compare (.json), and logs of train (.jsonl)",
                        "tureen eval SCENE DATASET -o FOLDER measures a scene");
  std::string text = Input::open(file).read_text();
  if (text.empty()) throw UnknownResult({file}, "is empty");
  if (text.starts_with("{\"step\":")) return {training(file, text)};  // every log begins with this
  const nlohmann::json document = parse_json(text, file);
  if (text.starts_with("\xef\xbb\xbf"))
    text.erase(0, 3);  // a byte order mark is not valid JSON inside the page
  const JsonView root(document, file);
  const std::string format =
      document.is_object() ? document.value("format", nlohmann::json()).dump() : "";
  if (format == "\"tureen web bench\"") return web_bench(file);
  if (format == "\"tureen bench\"") {
    results::bench_result_from_json(text, file);
    return {{file, "bench", text}};
  }
  if (format == "\"tureen tradeoff\"") {
    check_tradeoff(root);
    return {{file, "tradeoff", text}};
  }
  if (format == "\"tureen measurements\"") {
    check_measurements(root);
    return {{file, "measurements", text}};
  }
  if (format == "null" && document.contains("views") && document.contains("mean")) {
    check_eval(root);
    return {{file, "eval", text}};
  }
  if (format == "null" && document.contains("a") && document.contains("b")) {
    std::vector<ReportResult> sides;
    for (const char* side : {"a", "b"}) {
      check_eval(root[side]);
      sides.push_back({file, "eval", document[side].dump()});
    }
    return sides;
  }
  throw UnknownResult({file}, "not a result of bench, tradeoff, train, eval or ./dev");
}

std::vector<ReportResult> read_folder(const fs::path& folder) {
  std::vector<std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (const std::string extension = extension_of(entry.path());
        entry.is_regular_file() && (extension == ".json" || extension == ".jsonl"))
      files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  std::vector<ReportResult> results;
  for (const std::string& file : files) try {
      for (ReportResult& each : read_file(file)) results.push_back(std::move(each));
    } catch (const UnknownResult&) {
    }
  if (results.empty())
    throw InputError({folder.string()}, "the folder has no results in .json or .jsonl files");
  return results;
}

}  // namespace

std::vector<ReportResult> read_results(const fs::path& path) {
  require_there(path);
  try {
    return fs::is_directory(path) ? read_folder(path) : read_file(path.string());
  } catch (const fs::filesystem_error& error) {
    throw InputError({error.path1().string()}, error.code().message());
  }
}

}  // namespace tureen::cli
