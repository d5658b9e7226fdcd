#include "cli/bench_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <set>

#include "cli/bench_words.hpp"
#include "runtime/camera_sets.hpp"

namespace tureen::cli {

namespace {

using Rows = std::vector<std::vector<double>>;

constexpr int most_ticks = 9;

template <class Key>
std::vector<std::string> distinct(const BenchResult& result, Key key) {
  std::vector<std::string> names;
  for (const BenchMeasurement& measurement : result.measurements)
    if (std::find(names.begin(), names.end(), key(measurement)) == names.end())
      names.push_back(key(measurement));
  return names;
}

std::vector<std::string> camera_sets(const BenchResult& result) {
  return distinct(result, [](const BenchMeasurement& m) { return m.camera_set; });
}

std::vector<std::string> configurations(const BenchResult& result) {
  return distinct(result, [](const BenchMeasurement& m) { return m.configuration; });
}

double megapixels(const BenchMeasurement& m) { return 1e-6 * double(m.width) * double(m.height); }

/// Blocks of data and the words that draw them, comma by comma.
class Lines {
 public:
  void add(const Rows& rows, const std::string& how, const std::string& name) {
    const std::string block = fmt::format("data{}", count_++);
    data_ += plot_data(block, rows);
    plots_ += fmt::format("{}${} {} linetype {} title {}", plots_.empty() ? "" : ", \\\n  ", block,
                          how, count_, plot_text(name));
  }
  bool empty() const { return count_ == 0; }
  std::string script(const std::string& settings) const {
    return data_ + settings + "plot " + plots_ + "\n";
  }

 private:
  std::string data_, plots_;
  int count_ = 0;
};

/// Software rasterisers are never to be mistaken for hardware.
std::string device_of(const BenchResult& result) {
  return result.device.renderer + (result.device.software ? " (software)" : "");
}

/// Two at least: one says nothing about growth.
bool has_several_sizes(const BenchResult& result, const std::string& cameras) {
  std::set<double> sizes;
  for (const BenchMeasurement& m : result.measurements)
    if (m.camera_set == cameras) sizes.insert(megapixels(m));
  return sizes.size() > 1;
}

Figure time_against_pixels(const BenchResult& result, const std::string& cameras) {
  Lines lines;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  glm::dvec2 low(infinity), high(0);  // megapixels, milliseconds
  for (const std::string& configuration : configurations(result)) {
    Rows rows;
    for (const BenchMeasurement& m : result.measurements)
      if (m.configuration == configuration && m.camera_set == cameras)
        rows.push_back({megapixels(m), m.frame_ms.median, m.frame_ms.min_of_medians,
                        std::max(m.frame_ms.p95, m.frame_ms.median)});
    for (const std::vector<double>& row : rows) {
      low = glm::min(low, {row[0], row[2]});
      high = glm::max(high, {row[0], row[3]});
    }
    std::sort(rows.begin(), rows.end());
    if (!rows.empty()) lines.add(rows, "using 1:2:3:4 with yerrorlines", configuration);
  }
  const std::string title =
      fmt::format("{}: frame time against pixels, {}", result.scene.name, cameras);
  return {
      plot_identifier("pixels " + cameras),
      fmt::format("Frame time against the pixels of a frame, cameras {}: medians, with bars from "
                  "the fastest round's median to the 95th percentile; both axes logarithmic. {}.",
                  cameras, device_of(result)),
      {title,
       lines.script(
           "set title " + plot_text(title) + "\nset logscale xy\nset key top left\n" +
           plot_ticks('x', PlotAxis::logarithmic(low.x, high.x, most_ticks)) +
           plot_ticks('y', PlotAxis::logarithmic(low.y, high.y, most_ticks)) +
           "set xlabel 'megapixels a frame'\nset ylabel 'ms a frame'\n"
           "set autoscale fix\nset offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05\n")}};
}

/// The size with the most pixels that was measured with these cameras.
std::string largest_size(const BenchResult& result, const std::string& cameras) {
  const BenchMeasurement* largest = nullptr;
  for (const BenchMeasurement& m : result.measurements)
    if (m.camera_set == cameras && (!largest || megapixels(m) > megapixels(*largest))) largest = &m;
  return largest ? largest->size : std::string();
}

/// How gnuplot marks the views: by name where they have one, else by number.
std::string view_marks(const std::string& cameras, std::size_t views) {
  if (cameras != "adversarial" || views != adversarial_names.size())
    return fmt::format("set xtics {}\nset xlabel 'view'\n", 1 + views / 16);
  std::string names;
  for (std::size_t view = 0; view < views; ++view)
    names += fmt::format("{}{} {}", view ? ", " : "", plot_text(adversarial_names[view]), view);
  return "set xtics (" + names + ")\n";
}

std::vector<Figure> times_by_view(const BenchResult& result, const std::string& cameras) {
  const std::string size = largest_size(result, cameras);
  Lines lines;
  std::size_t views = 0;
  for (const BenchMeasurement& m : result.measurements) {
    if (m.camera_set != cameras || m.size != size || m.views_ms.size() < 2) continue;
    views = std::max(views, m.views_ms.size());
    Rows rows;
    for (std::size_t view = 0; view < m.views_ms.size(); ++view)
      rows.push_back({double(view), m.views_ms[view]});
    lines.add(rows, "using 1:2 with linespoints", m.configuration);
  }
  if (lines.empty()) return {};
  const std::string title =
      fmt::format("{}: frame time by view, {} at {}", result.scene.name, cameras, size);
  return {
      {plot_identifier("views " + cameras),
       fmt::format("The median of each view, cameras {} at {}. {}.", cameras, size,
                   device_of(result)),
       {title, lines.script("set title " + plot_text(title) +
                            "\nset yrange [0:*]\nset key top left\n" + view_marks(cameras, views) +
                            "set ylabel 'ms a frame'\n"
                            "set offsets 0.5, 0.5, graph 0.1, 0\n")}}};
}

std::vector<Figure> ratio_bars(const BenchResult& result) {
  const std::string reference = reference_configuration(result);
  const std::vector<std::string> names = configurations(result);
  const auto place = [](const BenchMeasurement& m) { return m.camera_set + "\n" + m.size; };
  const std::vector<std::string> places = distinct(result, place);
  if (names.size() < 2) return {};
  // Bars stand in groups, a group a place, and the groups a bar's width apart.
  const double width = 1.0 / double(names.size());
  Lines lines;
  for (std::size_t i = 0; i < names.size(); ++i) {
    Rows rows;
    for (const BenchMeasurement& m : result.measurements) {
      if (m.configuration != names[i]) continue;
      const auto group = std::find(places.begin(), places.end(), place(m)) - places.begin();
      const double ratio = times_as_fast(result, m);
      if (ratio > 0)
        rows.push_back(
            {double(group) + (double(i) + 0.5 - 0.5 * double(names.size())) * 0.8 * width, ratio,
             0.72 * width});
    }
    if (!rows.empty()) lines.add(rows, "using 1:2:3 with boxes", names[i]);
  }
  if (lines.empty()) return {};
  std::string labels;
  std::size_t longest = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    labels += fmt::format("{}{} {}", i ? ", " : "", plot_text(places[i]), i);
    longest = std::max(longest, places[i].size());
  }
  // Rotated by 30 degrees a label reaches 0.87 of its length to the left of its bars. Room for all
  // of it, as if the bars stood at the axis; never less than the axis' own numbers and name take,
  // and with names that no plot has room for a quarter of the width.
  const std::size_t margin = std::clamp<std::size_t>(longest * 87 / 100 + 1, 10, 30);
  const std::string title = fmt::format("{}: times as fast as '{}'", result.scene.name, reference);
  return {{plot_identifier("ratios"),
           fmt::format("How many times as fast as '{}', cameras and sizes side by side; as "
                       "measured, also where a spread explains it or is not known. {}.",
                       reference, device_of(result)),
           {title,
            lines.script("set title " + plot_text(title) +
                         "\nset yrange [0:*]\nset key outside bottom center horizontal\n"
                         "set xtics rotate by 30 right scale 0 (" +
                         labels +
                         ")\nset ylabel 'times as fast'\n"
                         "set arrow from graph 0, first 1 to graph 1, first 1 nohead "
                         "linecolor rgb '#636c76' front\n"
                         "set xrange [-0.6:" +
                         fmt::format("{}]\nset lmargin {}\n", double(places.size()) - 0.4, margin)),
            960, 520}}};
}

}  // namespace

std::vector<Figure> bench_plots(const BenchResult& result) {
  std::vector<Figure> plots;
  for (const std::string& cameras : camera_sets(result)) {
    if (has_several_sizes(result, cameras)) plots.push_back(time_against_pixels(result, cameras));
    for (Figure& plot : times_by_view(result, cameras)) plots.push_back(std::move(plot));
  }
  for (Figure& plot : ratio_bars(result)) plots.push_back(std::move(plot));
  // Two sets of cameras may differ in characters alone that files do not have.
  for (std::size_t i = 0; i < plots.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (plots[i].file == plots[j].file) plots[i].file += fmt::format("-{}", i);
  return plots;
}

}  // namespace tureen::cli
