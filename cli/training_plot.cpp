#include "cli/training_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <string_view>

#include "cli/html_page.hpp"
#include "cli/plot_axis.hpp"

namespace tureen::cli {

namespace {

struct Point {
  double x, y;
};
using Line = std::vector<Point>;

/// In pixels of the SVG; y downwards.
struct Box {
  double left, top, width, height;
};

constexpr double picture_width = 960;
static_assert(std::string_view(training_plot_beginning).ends_with(" 960 "));
constexpr double panel_height = 290;
constexpr double legend_row = 22;
constexpr Box loss_box{64, 52, 382, panel_height};
constexpr Box psnr_box{548, 52, 382, panel_height};
constexpr double below_panels = 60;  // tick labels and the names of the axes

/// A line has no more points than this: more than there are pixels would only make the file large.
constexpr std::size_t most_points = 400;
/// PSNR further below the best than this is cut off: where training begins nobody needs to read it.
constexpr double most_decibels = 18;

/// Okabe and Ito's colours, which people who confuse red and green tell apart; lighter on dark.
/// Runs beyond the sixth repeat them with dashes.
struct Paint {
  const char* light;
  const char* dark;
};
constexpr std::array<Paint, 6> paints{{{"#0072b2", "#4db2ee"},
                                       {"#d55e00", "#ff8f40"},
                                       {"#009e73", "#2fcf9f"},
                                       {"#b3578a", "#e59ac2"},
                                       {"#a87900", "#f0c040"},
                                       {"#555f6b", "#b4bfcc"}}};
constexpr std::array dashes{"", "7 4", "2 3", "9 3 2 3"};

std::string style_sheet() {
  std::string light, dark;
  for (std::size_t i = 0; i < paints.size(); ++i) {
    light += fmt::format("--run{}:{};", i, paints[i].light);
    dark += fmt::format("--run{}:{};", i, paints[i].dark);
  }
  return "<style>\n"
         "svg{--page:#ffffff;--ink:#1f2328;--faint:#636c76;--grid:#e4e8ec;" +
         light +
         "font:13px system-ui,-apple-system,'Segoe UI','DejaVu Sans',sans-serif;fill:var(--ink)}\n"
         "@media(prefers-color-scheme:dark){svg{--page:#0d1117;--ink:#e6edf3;--faint:#9198a1;"
         "--grid:#262c34;" +
         dark +
         "}}\n"
         ".page{fill:var(--page)}.title{font-weight:600;font-size:14px}"
         ".tick,.axis{fill:var(--faint);font-size:12px}.grid{stroke:var(--grid)}"
         ".line{fill:none;stroke-linejoin:round;stroke-linecap:round;stroke-width:2}"
         ".thin{stroke-width:1;opacity:.55}"
         ".dot{stroke:var(--page);stroke-width:1}\n</style>\n";
}

std::string text_at(double x, double y, const char* classes, const char* anchor,
                    const std::string& text) {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
                     classes, x, y, anchor, html_escaped(text));
}

/// What a run shows in a panel.
struct Curves {
  Line thin;                      // behind
  Line thick;                     // in front
  bool dots = false;              // at each point of the thick line
  std::vector<std::string> tips;  // of the dots, as many
};

/// Means over stretches of equal length, so that about most_points remain, and the end itself.
Line reduced(const Line& line) {
  if (line.size() <= most_points) return line;
  Line result;
  for (std::size_t i = 0; i < most_points; ++i) {
    const std::size_t begin = i * line.size() / most_points;
    const std::size_t end = (i + 1) * line.size() / most_points;
    Point sum{0, 0};
    for (std::size_t j = begin; j < end; ++j) {
      sum.x += line[j].x;
      sum.y += line[j].y;
    }
    result.push_back({sum.x / double(end - begin), sum.y / double(end - begin)});
  }
  result.push_back(line.back());
  return result;
}

/// The values of one kind over x, smoothed over a fiftieth of the run.
template <class X, class Y>
Line smooth_line(const std::vector<TrainingRecord>& records, X x, Y y) {
  std::vector<double> values;
  for (const TrainingRecord& record : records) values.push_back(y(record));
  const std::vector<double> smooth = smoothed(values, std::max(1.0, double(values.size()) / 50));
  Line line;
  for (std::size_t i = 0; i < smooth.size(); ++i)
    if (std::isfinite(smooth[i])) line.push_back({x(records[i]), smooth[i]});
  return reduced(line);
}

Curves loss_curves(const TrainingRun& run) {
  // A logarithm has no place for zero.
  return {{},
          smooth_line(
              run.records, [](const TrainingRecord& r) { return double(r.step); },
              [](const TrainingRecord& r) {
                return r.loss > 0 ? r.loss : std::numeric_limits<double>::quiet_NaN();
              }),
          false,
          {}};
}

Curves psnr_curves(const TrainingRun& run) {
  Curves curves;
  curves.dots = true;
  const auto seconds = [](const TrainingRecord& r) { return r.seconds; };
  curves.thin =
      smooth_line(run.records, seconds, [](const TrainingRecord& r) { return r.train_psnr_db; });
  for (const TrainingRecord& record : run.records) {
    if (!record.test_psnr_db || !std::isfinite(*record.test_psnr_db)) continue;
    curves.thick.push_back({record.seconds, *record.test_psnr_db});
    curves.tips.push_back(fmt::format("{}: step {}, {:.0f} s, {:.2f} dB", run.name, record.step,
                                      record.seconds, *record.test_psnr_db));
  }
  return curves;
}

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  bool empty() const { return !(low <= high); }
};

struct Extents {
  Extent x, y;
};

Extents extents(const std::vector<Curves>& all) {
  Extents result;
  for (const Curves& curves : all)
    for (const Line* line : {&curves.thin, &curves.thick})
      for (const Point& point : *line) {
        result.x.include(point.x);
        result.y.include(point.y);
      }
  return result;
}

/// A panel's frame and what maps values into it.
struct Panel {
  Box box;
  PlotAxis x, y;
  const char* clip;
  std::string title, x_name;

  Point place(Point value) const {
    return {box.left + box.width * x.position(value.x),
            box.top + box.height * (1 - y.position(value.y))};
  }
};

std::string frame(const Panel& panel) {
  const Box& box = panel.box;
  const double bottom = box.top + box.height;
  std::string svg = fmt::format(
      "<clipPath id=\"{}\"><rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>"
      "</clipPath>\n",
      panel.clip, box.left - 4, box.top - 4, box.width + 8, box.height + 8);
  svg += text_at(box.left, box.top - 20, "title", "start", panel.title);
  for (const Tick& tick : panel.y.ticks()) {
    const double y = panel.place({panel.x.low(), tick.value}).y;
    svg +=
        fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}h{:.1f}\"/>\n", box.left, y, box.width);
    svg += text_at(box.left - 8, y + 4, "tick", "end", tick.label);
  }
  for (const Tick& tick : panel.x.ticks()) {
    const double x = box.left + box.width * panel.x.position(tick.value);
    svg +=
        fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}v{:.1f}\"/>\n", x, box.top, box.height);
    svg += text_at(x, bottom + 18, "tick", "middle", tick.label);
  }
  return svg + text_at(box.left + box.width / 2, bottom + 40, "axis", "middle", panel.x_name);
}

std::string stroke(std::size_t run) {
  std::string style = fmt::format("stroke:var(--run{})", run % paints.size());
  const char* dash = dashes[run / paints.size() % dashes.size()];
  if (*dash) style += fmt::format(";stroke-dasharray:{}", dash);
  return style;
}

std::string path(const Panel& panel, const Line& line, const char* classes, std::size_t run) {
  if (line.size() < 2) return {};
  std::string data;
  for (const Point& point : line) {
    const Point at = panel.place(point);
    data += fmt::format("{}{:.1f} {:.1f}", data.empty() ? "M" : "L", at.x, at.y);
  }
  return fmt::format("<path class=\"{}\" style=\"{}\" clip-path=\"url(#{})\" d=\"{}\"/>\n", classes,
                     stroke(run), panel.clip, data);
}

std::string drawn(const Panel& panel, const Curves& curves, std::size_t run) {
  std::string svg = path(panel, curves.thin, "line thin", run);
  svg += path(panel, curves.thick, "line", run);
  if (!curves.dots) return svg;
  for (std::size_t i = 0; i < curves.thick.size(); ++i) {
    if (panel.y.position(curves.thick[i].y) < 0) continue;
    const Point at = panel.place(curves.thick[i]);
    svg += fmt::format(
        "<circle class=\"dot\" style=\"fill:var(--run{})\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.6\">"
        "<title>{}</title></circle>\n",
        run % paints.size(), at.x, at.y, html_escaped(curves.tips[i]));
  }
  return svg;
}

Panel loss_panel(const std::vector<Curves>& all) {
  Extents found = extents(all);
  if (found.y.empty()) found = {{0, 1}, {0.1, 1}};  // not one finite loss
  return {loss_box,
          PlotAxis::linear(0, found.x.high, 6),
          PlotAxis::logarithmic(found.y.low / 1.05, found.y.high * 1.05, 7),
          "loss",
          "Loss",
          "steps"};
}

Panel psnr_panel(const std::vector<Curves>& all) {
  Extents found = extents(all);
  if (found.y.empty()) found = {{0, 1}, {0, 30}};
  const double high = found.y.high + 0.5;
  PlotAxis time = PlotAxis::duration(found.x.high, 6);
  const std::string unit = time.unit();
  return {psnr_box,
          std::move(time),
          PlotAxis::linear(std::max(found.y.low - 0.5, high - most_decibels), high, 10),
          "psnr",
          "PSNR in dB",
          unit};
}

/// Rows of names with a sample of their line, and their height.
struct Legend {
  std::string svg;
  double height = 0;
};

Legend legend(std::span<const TrainingRun> runs, double top) {
  Legend result;
  double x = loss_box.left;
  double y = top;
  const auto entry = [&](const std::string& sample, const std::string& name) {
    // An SVG cannot measure its text before it is drawn: letters of 13 px are 7.2 px wide or less
    // on average.
    const double width = 44 + 7.2 * double(name.size());
    if (x > loss_box.left && x + width > picture_width - 20) {
      x = loss_box.left;
      y += legend_row;
    }
    result.svg += fmt::format("<g transform=\"translate({:.1f} {:.1f})\">{}", x, y, sample);
    result.svg += text_at(30, 4, "", "start", name) + "</g>\n";
    x += width;
  };
  if (runs.size() > 1)
    for (std::size_t i = 0; i < runs.size(); ++i)
      entry(fmt::format("<path class=\"line\" style=\"{}\" d=\"M0 0h22\"/>", stroke(i)),
            runs[i].name);
  const char* grey = "stroke:var(--faint)";
  if (runs.size() > 1) {
    x = loss_box.left;
    y += legend_row;
  }
  entry(fmt::format("<path class=\"line thin\" style=\"{}\" d=\"M0 0h22\"/>", grey),
        "training batches, smoothed");
  entry(fmt::format("<path class=\"line\" style=\"{}\" d=\"M0 0h22\"/><circle class=\"dot\" "
                    "style=\"fill:var(--faint)\" cx=\"11\" r=\"3.6\"/>",
                    grey),
        "held-out views");
  result.height = y - top + legend_row;
  return result;
}

}  // namespace

std::vector<double> smoothed(std::span<const double> values, double window) {
  assert(window >= 1);
  const double keep = 1 - 1 / window;
  double sum = 0, weight = 0;
  std::vector<double> result;
  for (const double value : values) {
    if (!std::isfinite(value)) {
      result.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    sum = keep * sum + value;
    weight = keep * weight + 1;
    result.push_back(sum / weight);
  }
  return result;
}

std::string training_plot(std::span<const TrainingRun> runs) {
  assert(!runs.empty());
  std::vector<Curves> loss, psnr;
  for (const TrainingRun& run : runs) {
    assert(!run.records.empty());
    loss.push_back(loss_curves(run));
    psnr.push_back(psnr_curves(run));
  }
  const Panel left = loss_panel(loss), right = psnr_panel(psnr);
  const double legend_top = loss_box.top + panel_height + below_panels + 6;
  const Legend names = legend(runs, legend_top);
  const double height = legend_top + names.height;

  std::string svg = fmt::format(
      "{0}{2}\" width=\"{1}\" height=\"{2}\" role=\"img\">\n<title>Loss and PSNR of "
      "training</title>\n",
      training_plot_beginning, picture_width, height);
  svg += style_sheet();
  svg += "<rect class=\"page\" width=\"100%\" height=\"100%\"/>\n";
  svg += frame(left) + frame(right);
  for (std::size_t i = 0; i < runs.size(); ++i) svg += drawn(left, loss[i], i);
  for (std::size_t i = 0; i < runs.size(); ++i) svg += drawn(right, psnr[i], i);
  return svg + names.svg + "</svg>\n";
}

}  // namespace tureen::cli
