#include "jobs/bench/bench_json.hpp"

#include "jobs/bench/json_reading.hpp"
#include "jobs/bench/plan_json.hpp"
#include "jobs/bench/provenance.hpp"

namespace tureen::results {

namespace {

constexpr const char* format_name = "tureen bench";

/// p99 or the 1 % low; null with fewer than 100 samples.
Json slowest_percent(const FrameStatistics& ms, double figure) {
  return tells_slowest_percent(ms) ? Json(figure) : Json(nullptr);
}

Json to_json(const FrameStatistics& ms) {
  return {{"mean", ms.mean},     {"median", ms.median},
          {"p95", ms.p95},       {"p99", slowest_percent(ms, ms.p99)},
          {"spread", ms.spread}, {"min_of_medians", ms.min_of_medians}};
}

Json to_json(const BenchConfiguration& configuration) {
  return {{"name", configuration.name},
          {"options", configuration.options},
          {"plan", configuration.plan},
          {"specialisations", specialisations_json(configuration.specialisations)},
          {"plan_ms", configuration.plan_ms},
          {"upload_ms", configuration.upload_ms},
          {"device_mib", configuration.device_mib}};
}

Json to_json(const BenchMeasurement& measurement) {
  Json passes = nullptr;
  // A list, because JSON libraries may reorder the members of an object.
  for (const auto& [name, ms] : measurement.passes_ms)
    passes.push_back({{"pass", name}, {"ms", ms}});
  return {{"configuration", measurement.configuration},
          {"camera_set", measurement.camera_set},
          {"size", measurement.size},
          {"width", measurement.width},
          {"height", measurement.height},
          {"views", measurement.views},
          {"rounds", measurement.frame_ms.rounds},
          {"frames_per_sample", measurement.frames_per_sample},
          {"frames", measurement.frames},
          {"frame_ms", to_json(measurement.frame_ms)},
          {"fps", measurement.fps},
          {"low_1_percent_fps",
           slowest_percent(measurement.frame_ms, measurement.frame_ms.low_1_percent_fps)},
          {"aa_spread", measurement.aa_spread},
          {"stable", measurement.stable},
          {"passes_ms", passes},
          {"passes_gap", name_of(measurement.passes_gap)},
          {"passes_reason", measurement.passes_reason},
          {"gpu_ms", measurement.gpu_ms ? Json(*measurement.gpu_ms) : Json(nullptr)},
          {"order_ms", measurement.order_ms ? Json(*measurement.order_ms) : Json(nullptr)},
          {"views_ms", measurement.views_ms},
          {"pixels_hash", measurement.pixels_hash},
          {"picture", measurement.image ? Json(*measurement.image) : Json(nullptr)}};
}

/// A frame time in milliseconds, above 0 because ratios divide by it, at most 1e9 (eleven days).
double frame_ms(const JsonView& view) { return number_in(view, 1e-6, 1e9); }
double not_negative(const JsonView& view) { return number_in(view, 0, 1e9); }

FrameStatistics frame_statistics(const JsonView& measurement) {
  const JsonView ms = measurement["frame_ms"];
  const int rounds = integer(measurement["rounds"]);
  const std::size_t samples = std::size_t(rounds) * std::size_t(integer(measurement["views"]));
  if (tells_slowest_percent({.samples = samples}) && ms["p99"].value().is_null())
    ms["p99"].fail("is null, but there are " + std::to_string(samples) + " samples");
  return {
      .mean = frame_ms(ms["mean"]),
      .median = frame_ms(ms["median"]),
      .p95 = frame_ms(ms["p95"]),
      .p99 = unless_null(ms["p99"], frame_ms).value_or(0),
      .min_of_medians = frame_ms(ms["min_of_medians"]),
      .spread = not_negative(ms["spread"]),
      .low_1_percent_fps = unless_null(measurement["low_1_percent_fps"], not_negative).value_or(0),
      .rounds = rounds,
      .samples = samples};
}

BenchConfiguration configuration(const JsonView& view) {
  return {.name = view["name"].text(),
          .options = texts(view["options"]),
          .plan = texts(view["plan"]),
          .plan_ms = view["plan_ms"].number(),
          .upload_ms = view["upload_ms"].number(),
          .device_mib = view["device_mib"].number(),
          .specialisations = specialisations_of(view)};
}

std::vector<std::pair<std::string, double>> passes(const JsonView& view) {
  if (view.value().is_null()) return {};
  return list(view, [](const JsonView& each) {
    return std::pair<std::string, double>(each["pass"].text(), each["ms"].number());
  });
}

PassTimesGap passes_gap(const JsonView& measurement) {
  const std::optional<JsonView> name = measurement.find("passes_gap");
  if (!name)  // results of earlier versions have only the sentence
    return measurement["passes_reason"].text().empty() ? PassTimesGap::none : PassTimesGap::other;
  const std::optional<PassTimesGap> gap = pass_times_gap(name->text());
  if (!gap) name->fail("'" + name->text() + "' is not a reason for missing pass times");
  return *gap;
}

BenchMeasurement measurement(const JsonView& view) {
  const auto text = [](const JsonView& each) { return each.text(); };
  const std::optional<JsonView> order = view.find("order_ms");
  return {.configuration = view["configuration"].text(),
          .camera_set = view["camera_set"].text(),
          .size = view["size"].text(),
          .width = integer(view["width"]),
          .height = integer(view["height"]),
          .views = integer(view["views"]),
          .frames_per_sample = integer(view["frames_per_sample"]),
          .frames = integer(view["frames"]),
          .frame_ms = frame_statistics(view),
          .fps = view["fps"].number(),
          .aa_spread = not_negative(view["aa_spread"]),
          .stable = view["stable"].boolean(),
          .passes_ms = passes(view["passes_ms"]),
          .passes_gap = passes_gap(view),
          .passes_reason = view["passes_reason"].text(),
          .gpu_ms = unless_null(view["gpu_ms"], not_negative),
          .order_ms = order ? unless_null(*order, not_negative) : std::nullopt,
          .views_ms = list(view["views_ms"], not_negative),
          .pixels_hash = view["pixels_hash"].text(),
          .image = unless_null(view["picture"], text)};
}

/// A number that results of earlier versions lack.
double number_or_0(const JsonView& view, const char* key) {
  const std::optional<JsonView> found = view.find(key);
  return found ? found->number() : 0;
}

}  // namespace

Json to_json(const BenchResult& result) {
  Json configurations = Json::array(), measurements = Json::array();
  for (const BenchConfiguration& each : result.configurations)
    configurations.push_back(to_json(each));
  for (const BenchMeasurement& each : result.measurements) measurements.push_back(to_json(each));
  Json json{{"format", format_name},
            {"version", bench_result_version},
            {"date", result.date},
            {"program", to_json(result.program)},
            {"scene", to_json(result.scene)},
            {"machine", to_json(result.machine)},
            {"device", to_json(result.device)},
            {"protocol",
             {{"clock", result.protocol.clock},
              {"processor_time", result.protocol.processor_time},
              {"rounds", result.protocol.rounds},
              {"aa_spread", result.protocol.aa_spread}}},
            {"load",
             {{"read_ms", result.load.read_ms},
              {"plan_ms", result.load.plan_ms},
              {"upload_ms", result.load.upload_ms},
              {"peak_mib", result.load.peak_mib},
              {"device_mib", result.load.device_mib},
              {"disk_mib", result.load.disk_mib},
              {"memory_mib", result.load.memory_mib}}},
            {"configurations", configurations},
            {"measurements", measurements},
            {"notes", result.notes}};
  if (result.peak_mib) json["peak_mib"] = *result.peak_mib;
  return json;
}

BenchResult bench_result_from_json(const std::string& text, const std::string& file) {
  const nlohmann::json document = parse_json(text, file);
  const JsonView root(document, file);
  require_format(root, format_name, bench_result_version, "not a result of tureen bench");
  const JsonView protocol = root["protocol"], load = root["load"];
  if (root["measurements"].size() == 0) root["measurements"].fail("is empty");
  BenchProgram program = program_of(root["program"]);
  // Results of earlier versions have only the option.
  const std::optional<JsonView> known = protocol.find("processor_time");
  const bool processor_time = known ? known->boolean()
                                    : std::count(program.arguments.begin(), program.arguments.end(),
                                                 "--processor-time") > 0;
  const std::optional<JsonView> peak = root.find("peak_mib");
  return {.date = root["date"].text(),
          .program = std::move(program),
          .scene = scene_of(root["scene"]),
          .machine = machine_of(root["machine"]),
          .device = device_of(root["device"]),
          .protocol = {.clock = protocol["clock"].text(),
                       .processor_time = processor_time,
                       .rounds = integer(protocol["rounds"]),
                       .aa_spread = protocol["aa_spread"].number()},
          .load = {.read_ms = load["read_ms"].number(),
                   .plan_ms = load["plan_ms"].number(),
                   .upload_ms = load["upload_ms"].number(),
                   .peak_mib = load["peak_mib"].number(),
                   .device_mib = load["device_mib"].number(),
                   .disk_mib = number_or_0(load, "disk_mib"),
                   .memory_mib = number_or_0(load, "memory_mib")},
          .configurations = list(root["configurations"], configuration),
          .measurements = list(root["measurements"], measurement),
          .notes = texts(root["notes"]),
          .peak_mib = peak ? std::optional(peak->number()) : std::nullopt};
}

}  // namespace tureen::results
