#include "jobs/bench/bench_json.hpp"

#include <algorithm>

#include "jobs/bench/json_reading.hpp"
#include "jobs/bench/plan_json.hpp"

namespace tureen::results {

namespace {

constexpr const char* format_name = "tureen bench";

/// What a file may hold for a member.
struct Rule {
  double low = -INFINITY, high = INFINITY;  // of a number
  std::size_t longest = std::string::npos;  // of a text, in bytes
  bool may_lack = false;                    // files of earlier versions lack it
  bool omitted = false;                     // not written if it is empty; may lack
};
/// Ratios divide by these milliseconds; at most eleven days.
constexpr Rule above_0{.low = 1e-6, .high = 1e9};
constexpr Rule not_negative{.low = 0, .high = 1e9};
constexpr Rule later{.may_lack = true};
/// The usual limit for paths; names are shorter.
constexpr Rule short_text{.longest = 4096};

// Below, fields(io, value) lists the members of each part of a result once: a Writer writes them
// in this order, a Reader reads them.

class Writer {
 public:
  static constexpr bool reads = false;
  explicit Writer(Json& json) : json_(json) {}

  template <class T>
  void operator()(const char* key, const T& value, const Rule& rule = {}) {
    Json written = json_of(value);
    if (!rule.omitted || !(written.is_null() || written == "")) json_[key] = std::move(written);
  }
  template <class T>
  void part(const char* key, T& value) {
    fields(Writer(json_[key] = Json::object()), value);
  }
  template <class T>
  void list(const char* key, std::vector<T>& values) {
    json_[key] = Json::array();
    for (T& value : values) fields(Writer(json_[key].emplace_back(Json::object())), value);
  }

 private:
  template <class T>
  static Json json_of(const T& value) {
    return value;
  }
  template <class T>
  static Json json_of(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
  }
  static Json json_of(const PassTimesGap& gap) { return name_of(gap); }
  static Json json_of(const std::vector<AppliedSpecialisation>& list) {
    return specialisations_json(list);
  }
  /// A list, because JSON libraries may reorder the members of an object.
  static Json json_of(const std::vector<std::pair<std::string, double>>& passes) {
    Json json = nullptr;
    for (const auto& [pass, ms] : passes) json.push_back({{"pass", pass}, {"ms", ms}});
    return json;
  }

  Json& json_;
};

/// Throws InputError with the path of a missing or invalid member.
class Reader {
 public:
  static constexpr bool reads = true;
  explicit Reader(const JsonView& view) : view_(view) {}
  const JsonView& view() const { return view_; }

  template <class T>
  void operator()(const char* key, T& value, const Rule& rule = {}) {
    if ((rule.may_lack || rule.omitted) && !view_.find(key)) return;
    read(view_[key], value, rule);
  }
  template <class T>
  void part(const char* key, T& value) {
    fields(Reader(view_[key]), value);
  }
  template <class T>
  void list(const char* key, std::vector<T>& values) {
    const JsonView all = view_[key];
    for (std::size_t i = 0; i < all.size(); ++i) fields(Reader(all.at(i)), values.emplace_back());
  }

 private:
  static void read(const JsonView& view, std::string& text, const Rule& rule) {
    text = text_within(view, rule.longest);
  }
  static void read(const JsonView& view, int& number, const Rule&) { number = integer(view); }
  static void read(const JsonView& view, std::uint64_t& number, const Rule&) {
    number = view.natural();
  }
  static void read(const JsonView& view, double& number, const Rule& rule) {
    number = number_in(view, rule.low, rule.high);
  }
  static void read(const JsonView& view, bool& is, const Rule&) { is = view.boolean(); }
  static void read(const JsonView& view, PassTimesGap& gap, const Rule&) {
    const std::optional<PassTimesGap> known = pass_times_gap(view.text());
    if (!known) view.fail("'" + view.text() + "' is not a reason for missing pass times");
    gap = *known;
  }
  static void read(const JsonView& view, std::vector<AppliedSpecialisation>& list, const Rule&) {
    list = specialisations_of(view);
  }
  static void read(const JsonView& view, std::vector<std::pair<std::string, double>>& passes,
                   const Rule&) {
    if (view.value().is_null()) return;
    passes = results::list(view, [](const JsonView& each) {
      return std::pair(each["pass"].text(), each["ms"].number());
    });
  }
  template <class T>
  static void read(const JsonView& view, std::vector<T>& values, const Rule& rule) {
    for (std::size_t i = 0; i < view.size(); ++i) read(view.at(i), values.emplace_back(), rule);
  }
  template <class T>
  static void read(const JsonView& view, std::optional<T>& value, const Rule& rule) {
    if (!view.value().is_null()) read(view, value.emplace(), rule);
  }

  JsonView view_;
};

template <class Io>
void fields(Io io, BenchProgram& program) {
  io("version", program.version, short_text);
  io("commit", program.commit, short_text);
  io("arguments", program.arguments);
  io("build", program.build, {.longest = short_text.longest, .omitted = true});
}

template <class Io>
void fields(Io io, BenchScene& scene) {
  io("name", scene.name, short_text);
  io("path", scene.path, short_text);
  io("triangles", scene.triangles);
  io("splats", scene.splats, later);
  io("appearance", scene.appearance, short_text);
}

template <class Io>
void fields(Io io, Machine& machine) {
  io("cpu", machine.cpu, short_text);
  io("cores", machine.cores);
  io("memory_mib", machine.memory_mib, {.low = 0, .high = 1e12});
  io("rasteriser_threads", machine.rasteriser_threads, {.omitted = true});
}

template <class Io>
void fields(Io io, BenchDevice& device) {
  io("context", device.context, short_text);
  io("renderer", device.renderer, short_text);
  io("vendor", device.vendor, short_text);
  io("version", device.version, short_text);
  io("software", device.software);
}

template <class Io>
void fields(Io io, BenchProtocol& protocol) {
  io("clock", protocol.clock);
  io("processor_time", protocol.processor_time, later);
  io("rounds", protocol.rounds);
  io("aa_spread", protocol.aa_spread);
}

template <class Io>
void fields(Io io, BenchLoad& load) {
  io("read_ms", load.read_ms);
  io("plan_ms", load.plan_ms);
  io("upload_ms", load.upload_ms);
  io("peak_mib", load.peak_mib);
  io("device_mib", load.device_mib);
  io("disk_mib", load.disk_mib, later);
  io("memory_mib", load.memory_mib, later);
}

template <class Io>
void fields(Io io, BenchConfiguration& configuration) {
  io("name", configuration.name);
  io("options", configuration.options);
  io("plan", configuration.plan);
  io("specialisations", configuration.specialisations, later);
  io("plan_ms", configuration.plan_ms);
  io("upload_ms", configuration.upload_ms);
  io("device_mib", configuration.device_mib);
}

/// p99 and the 1 % low are null with fewer than 100 samples.
struct Slowest {
  FrameStatistics& ms;
  std::optional<double> p99 = {}, low_1_percent_fps = {};
};

template <class Io>
void fields(Io io, Slowest& slowest) {
  FrameStatistics& ms = slowest.ms;
  io("mean", ms.mean, above_0);
  io("median", ms.median, above_0);
  io("p95", ms.p95, above_0);
  io("p99", slowest.p99, above_0);
  io("spread", ms.spread, not_negative);
  io("min_of_medians", ms.min_of_medians, above_0);
  if constexpr (Io::reads)
    if (tells_slowest_percent(ms) && !slowest.p99)
      io.view()["p99"].fail("is null, but there are " + std::to_string(ms.samples) + " samples");
}

template <class Io>
void fields(Io io, BenchMeasurement& m) {
  Slowest slowest{m.frame_ms};
  if (!Io::reads && tells_slowest_percent(m.frame_ms)) {
    slowest.p99 = m.frame_ms.p99;
    slowest.low_1_percent_fps = m.frame_ms.low_1_percent_fps;
  }
  io("configuration", m.configuration);
  io("camera_set", m.camera_set);
  io("size", m.size);
  io("width", m.width);
  io("height", m.height);
  io("views", m.views);
  io("rounds", m.frame_ms.rounds);
  if constexpr (Io::reads)
    m.frame_ms.samples = std::size_t(m.frame_ms.rounds) * std::size_t(m.views);
  io("frames_per_sample", m.frames_per_sample);
  io("frames", m.frames);
  io.part("frame_ms", slowest);
  io("fps", m.fps);
  io("low_1_percent_fps", slowest.low_1_percent_fps, not_negative);
  m.frame_ms.p99 = slowest.p99.value_or(0);
  m.frame_ms.low_1_percent_fps = slowest.low_1_percent_fps.value_or(0);
  io("aa_spread", m.aa_spread, not_negative);
  io("stable", m.stable);
  io("passes_ms", m.passes_ms);
  io("passes_gap", m.passes_gap, later);
  io("passes_reason", m.passes_reason);
  if constexpr (Io::reads)  // results of earlier versions have only the sentence
    if (!io.view().find("passes_gap"))
      m.passes_gap = m.passes_reason.empty() ? PassTimesGap::none : PassTimesGap::other;
  io("gpu_ms", m.gpu_ms, not_negative);
  io("order_ms", m.order_ms, {.low = 0, .high = 1e9, .may_lack = true});
  io("views_ms", m.views_ms, not_negative);
  io("pixels_hash", m.pixels_hash);
  io("picture", m.image);
}

template <class Io>
void fields(Io io, BenchResult& result) {
  io("date", result.date);
  io.part("program", result.program);
  io.part("scene", result.scene);
  io.part("machine", result.machine);
  io.part("device", result.device);
  io.part("protocol", result.protocol);
  io.part("load", result.load);
  io.list("configurations", result.configurations);
  io.list("measurements", result.measurements);
  io("notes", result.notes);
  io("peak_mib", result.peak_mib, {.omitted = true});
}

template <class T>
Json written(T value) {
  Json json = Json::object();
  fields(Writer(json), value);
  return json;
}

template <class T>
T read(const JsonView& view) {
  T value;
  fields(Reader(view), value);
  return value;
}

}  // namespace

Json to_json(const BenchProgram& program) { return written(program); }
Json to_json(const BenchScene& scene) { return written(scene); }
Json to_json(const Machine& machine) { return written(machine); }
Json to_json(const BenchDevice& device) { return written(device); }
BenchScene scene_of(const JsonView& view) { return read<BenchScene>(view); }
BenchDevice device_of(const JsonView& view) { return read<BenchDevice>(view); }

Json to_json(const BenchResult& result) {
  Json json{{"format", format_name}, {"version", bench_result_version}};
  json.update(written(result));
  return json;
}

BenchResult bench_result_from_json(const std::string& text, const std::string& file) {
  const nlohmann::json document = parse_json(text, file);
  const JsonView root(document, file);
  require_format(root, format_name, bench_result_version, "not a result of tureen bench");
  if (root["measurements"].size() == 0) root["measurements"].fail("is empty");
  BenchResult result = read<BenchResult>(root);
  // Results of earlier versions have only the option.
  const std::vector<std::string>& arguments = result.program.arguments;
  if (!root["protocol"].find("processor_time"))
    result.protocol.processor_time =
        std::count(arguments.begin(), arguments.end(), "--processor-time") > 0;
  return result;
}

}  // namespace tureen::results
