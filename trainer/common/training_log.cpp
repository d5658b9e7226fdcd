#include "trainer/common/training_log.hpp"

#include <cerrno>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/input.hpp"
#include "base/json/json_view.hpp"

namespace tureen::trainer {

namespace {

using Json = nlohmann::ordered_json;

double number_or_nan(const JsonView& value) {
  return value.value().is_null() ? std::numeric_limits<double>::quiet_NaN() : value.number();
}

TrainingRecord record_of(const JsonView& line) {
  TrainingRecord record;
  record.step = int(line["step"].natural(std::numeric_limits<int>::max()));
  if (const auto value = line.find("steps"))
    record.steps = int(value->natural(std::numeric_limits<int>::max()));
  record.seconds = line["seconds"].number();
  if (const auto value = line.find("seconds_left"); value && !value->value().is_null())
    record.seconds_left = value->number();
  record.loss = number_or_nan(line["loss"]);
  record.l1 = number_or_nan(line["l1"]);
  record.ssim = number_or_nan(line["ssim"]);
  record.train_psnr_db = number_or_nan(line["train_psnr_db"]);
  if (const auto value = line.find("test_psnr_db")) record.test_psnr_db = number_or_nan(*value);
  if (const auto splats = line.find("splats"))
    record.primitives = {PrimitiveKind::splats, splats->natural()};
  else
    record.primitives = {PrimitiveKind::triangles, line["triangles"].natural()};
  record.it_per_second = number_or_nan(line["it_per_second"]);
  record.non_finite = line["non_finite"].natural();
  record.ended_early = line.find("ended_early").has_value();
  return record;
}

/// The lines about the run, if this is the line of a plan.
std::optional<std::vector<std::string>> plan_of(const JsonView& line) {
  const auto plan = line.find("plan");
  if (!plan) return std::nullopt;
  std::vector<std::string> lines;
  if (const auto text = plan->find("text"))
    for (std::size_t i = 0; i < text->size(); ++i) lines.push_back(text->at(i).text());
  return lines;
}

std::uint64_t end_of(const ReadTrainingLog& log) {
  return log.ends.empty() ? log.begin : log.ends.back();
}

/// Appends the complete lines after end_of(log). On an error, those before the wrong one.
void read_lines(const std::filesystem::path& path, ReadTrainingLog& log) {
  std::vector<TrainingRecord>& records = log.records;
  Input input = Input::open(path);
  const std::uint64_t first = end_of(log);
  input.seek(first);
  const std::vector<std::byte> bytes = input.read_rest();
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    const std::size_t number = records.size() + (log.begin > 0 ? 2 : 1);
    if (end == std::string_view::npos) break;
    TrainingRecord record;
    try {
      const auto json = parse_json(text.substr(begin, end - begin), input.name(), first + begin);
      const JsonView line(json, input.name());
      if (auto plan = end_of(log) == 0 ? plan_of(line) : std::nullopt) {
        log.plan = std::move(*plan);
        begin = end + 1;
        log.begin = begin;
        continue;
      }
      record = record_of(line);
    } catch (const InputError& error) {
      throw InputError({input.name(), {}, number}, "not a training record: " + error.reason(),
                       error.hint());
    }
    if (!records.empty() && record.step <= records.back().step)
      throw InputError({input.name(), {}, number}, "step " + std::to_string(record.step) +
                                                       " does not follow the previous step");
    records.push_back(record);
    begin = end + 1;
    log.ends.push_back(first + begin);
  }
}

/// JSON has no NaN and no infinity: nlohmann writes null for them.
Json to_json(const TrainingRecord& record) {
  Json json{{"step", record.step}};
  if (record.steps) json["steps"] = *record.steps;
  json["seconds"] = record.seconds;
  if (record.seconds_left) json["seconds_left"] = *record.seconds_left;
  json.update({{"loss", record.loss},
               {"l1", record.l1},
               {"ssim", record.ssim},
               {"train_psnr_db", record.train_psnr_db}});
  if (record.test_psnr_db) json["test_psnr_db"] = *record.test_psnr_db;
  json[name_of(record.primitives.kind)] = record.primitives.count;
  json["it_per_second"] = record.it_per_second;
  json["non_finite"] = record.non_finite;
  if (record.ended_early) json["ended_early"] = true;
  return json;
}

}  // namespace

TrainingLog::TrainingLog(const std::filesystem::path& path, const char* mode)
    : name_(path.string()), file_(std::fopen(path.c_str(), mode)) {
  if (!file_)
    throw OutputError({name_, {}, {}}, std::string("cannot be opened: ") + std::strerror(errno));
}

TrainingLog TrainingLog::create(const std::filesystem::path& path) {
  return TrainingLog(path, "wb");
}

TrainingLog TrainingLog::resume(const std::filesystem::path& path, int step) {
  std::error_code error;
  if (std::filesystem::exists(path, error)) {
    ReadTrainingLog log;
    read_lines(path, log);
    std::uint64_t keep = log.begin;
    for (std::size_t i = 0; i < log.records.size() && log.records[i].step <= step; ++i)
      keep = log.ends[i];
    std::filesystem::resize_file(path, keep, error);
    if (error)
      throw OutputError({path.string(), {}, {}}, "cannot be shortened: " + error.message());
  }
  return TrainingLog(path, "ab");
}

void TrainingLog::append_plan(const std::string& plan) {
  append_line(R"({"step":0,"plan":)" + plan + "}");
}

void TrainingLog::append(const TrainingRecord& record) { append_line(to_json(record).dump()); }

void TrainingLog::append_line(std::string line) {
  line += '\n';
  if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size() ||
      std::fflush(file_.get()) != 0)
    throw OutputError({name_, {}, {}}, std::string("cannot be written: ") + std::strerror(errno));
}

std::vector<TrainingRecord> read_training_log(const std::filesystem::path& path) {
  require_there(path);
  ReadTrainingLog log;
  read_lines(path, log);
  return log.records;
}

bool TrainingLogTail::update() {
  std::error_code missing;
  const std::uint64_t found = std::filesystem::file_size(path_, missing);
  const std::uint64_t size = missing ? 0 : found;
  if (size == size_) return false;
  size_ = size;
  // Until there is a record, another run may have replaced the log unnoticed.
  if (log_.ends.empty() || size < end_of(log_)) log_ = {};
  if (missing) return true;
  if (log_.ends.empty()) {
    read_lines(path_, log_);
    return true;
  }
  try {
    read_lines(path_, log_);
  } catch (const InputError&) {  // another run may have written more than was there
    log_ = {};
    read_lines(path_, log_);
  }
  return true;
}

}  // namespace tureen::trainer
