#include "bench/growth_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>

#include "cli/figures.hpp"
#include "cli/gnuplot.hpp"
#include "cli/html_page.hpp"
#include "cli/plot_axis.hpp"
#include "cli/report.hpp"
#include "formats/output.hpp"

namespace tureen::test {

namespace {

namespace fs = std::filesystem;
using cli::HtmlPage;
using cli::Json;

constexpr const char* kinds[] = {"opaque", "cut-out"};

using Points = std::vector<const GrowthPoint*>;

template <typename Condition>
Points points_of(const Growth& growth, const std::string& kind, const Condition& condition) {
  Points result;
  for (const GrowthPoint& point : growth.points)
    if (point.kind == kind && condition(point)) result.push_back(&point);
  return result;
}

Points fitted_points(const Growth& growth, const std::string& kind) {
  return points_of(growth, kind, [](const GrowthPoint& point) { return point.series != "shape"; });
}

Points anchors_of(const Growth& growth, const std::string& kind) {
  return points_of(growth, kind, [](const GrowthPoint& point) { return point.anchor; });
}

double residual(const CostFit& fit, const GrowthPoint& point) {
  return fit.predict(point.sample) / point.sample.ms - 1;
}

double above_smallest(const std::vector<double>& values) {
  if (values.size() < 2) return 0;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high / *low - 1;
}

/// How much longer the anchors' slowest round took than their quickest.
double anchor_drift(const Growth& growth, const std::string& kind) {
  std::vector<double> rounds;
  for (const GrowthPoint* anchor : anchors_of(growth, kind))
    rounds.insert(rounds.end(), anchor->round_ms.begin(), anchor->round_ms.end());
  return above_smallest(rounds);
}

std::string frame_text(const GrowthPoint& point) {
  return fmt::format("{} triangles, {}x{}, {} layers",
                     cli::counted(std::uint64_t(point.sample.triangles)), point.width, point.height,
                     point.layers);
}

struct Axis {
  const char* series;
  const char* label;
  double (*value)(const GrowthPoint&);
};
constexpr Axis axes[] = {
    {"triangles", "triangles", [](const GrowthPoint& p) { return p.sample.triangles; }},
    {"pixels", "megapixels a frame",
     [](const GrowthPoint& p) { return 1e-6 * p.width * p.height; }},
    {"overdraw", "layers", [](const GrowthPoint& p) { return double(p.layers); }}};

std::string device_of(const Growth& growth) {
  return growth.renderer + (growth.software ? " (software)" : "") +
         (growth.processor_time ? ", processor time of all threads" : "");
}

cli::Plot series_plot(const Growth& growth, const Axis& axis) {
  std::string data, plots;
  int color = 0;
  double low = std::numeric_limits<double>::infinity(), high = 0;  // milliseconds
  for (const char* kind : kinds) {
    ++color;
    std::vector<std::vector<double>> measured, model;
    const auto fit = growth.fits.find(kind);
    const auto of_series = [&](const GrowthPoint& point) { return point.series == axis.series; };
    for (const GrowthPoint* point : points_of(growth, kind, of_series)) {
      measured.push_back({axis.value(*point), point->sample.ms, point->sample.ms,
                          std::max(point->p95_ms, point->sample.ms)});
      low = std::min(low, point->sample.ms);
      high = std::max({high, point->sample.ms, point->p95_ms});
      if (fit == growth.fits.end()) continue;
      model.push_back({axis.value(*point), fit->second.predict(point->sample)});
    }
    if (measured.empty()) continue;
    data += cli::plot_data(fmt::format("measured{}", color), measured);
    plots += fmt::format("{}$measured{} using 1:2:3:4 with yerrorbars linetype {} title {}",
                         plots.empty() ? "" : ", ", color, color, cli::plot_text(kind));
    if (model.empty()) continue;
    data += cli::plot_data(fmt::format("model{}", color), model);
    plots += fmt::format(", $model{} using 1:2 with lines linetype {} dashtype 2 title {}", color,
                         color, cli::plot_text(std::string(kind) + ", model"));
  }
  return {
      .title = fmt::format("Frame time against {}", axis.series),
      .script =
          data + "set logscale xy\nset key top left\nset ylabel 'ms a frame'\n" +
          // Less than a decade may have none of gnuplot's own ticks.
          cli::plot_ticks('y', cli::PlotAxis::logarithmic(low, high, 8)) + "set xlabel " +
          cli::plot_text(axis.label) +
          "\nset autoscale fix\nset offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05\nplot " +
          plots};
}

cli::Plot fit_plot(const Growth& growth) {
  std::string data, plots;
  int color = 0;
  for (const auto& [kind, fit] : growth.fits) {
    ++color;
    std::vector<std::vector<double>> rows;
    for (const GrowthPoint* point : fitted_points(growth, kind))
      rows.push_back({point->sample.ms, fit.predict(point->sample)});
    data += cli::plot_data(fmt::format("fit{}", color), rows);
    plots += fmt::format(", $fit{} using 1:2 with points linetype {} title {}", color, color,
                         cli::plot_text(kind));
  }
  return {.title = "The cost model against measurements",
          .script = data +
                    "set logscale xy\nset key top left\nset xlabel 'ms measured'\n"
                    "set ylabel 'ms by the model'\n"
                    "plot x with lines linecolor rgb '#636c76' title 'equal'" +
                    plots};
}

Json to_json(const Growth& growth) {
  Json points = Json::array(), fits = Json::object(), anchors = Json::object();
  for (const GrowthPoint& point : growth.points)
    points.push_back({{"kind", point.kind},
                      {"series", point.series},
                      {"triangles", point.sample.triangles},
                      {"layers", point.layers},
                      {"width", point.width},
                      {"height", point.height},
                      {"fragments", point.sample.fragments},
                      {"shaded_pixels", point.sample.shaded_pixels},
                      {"ms", point.sample.ms},
                      {"p95_ms", point.p95_ms},
                      {"aa_spread", point.aa_spread},
                      {"spread", point.spread},
                      {"round_ms", point.round_ms},
                      {"unsettled_rounds", point.unsettled_rounds},
                      {"elongation", point.elongation},
                      {"anchor", point.anchor}});
  for (const char* kind : kinds)
    if (!anchors_of(growth, kind).empty())
      anchors[kind] = {{"spread", anchor_spread(growth, kind)},
                       {"drift", anchor_drift(growth, kind)}};
  for (const auto& [kind, fit] : growth.fits)
    fits[kind] = {{"frame_ms", fit.ms[0]},
                  {"triangle_ns", 1e6 * fit.ms[1]},
                  {"fragment_ns", 1e6 * fit.ms[2]},
                  {"shaded_pixel_ns", 1e6 * fit.ms[3]},
                  {"standard_errors_ms", fit.standard_error},
                  {"residuals", fit.residuals}};
  return {{"format", "tureen growth"},
          {"version", 2},
          {"commit", growth.commit},
          {"cpu", growth.cpu},
          {"context", growth.context},
          {"renderer", growth.renderer},
          {"software", growth.software},
          {"processor_time", growth.processor_time},
          {"points", points},
          {"anchors", anchors},
          {"fits", fits}};
}

void add_table(HtmlPage& page, const Growth& growth) {
  std::vector<std::vector<std::string>> rows;
  for (const char* kind : kinds) {
    const auto fit = growth.fits.find(kind);
    for (const GrowthPoint* point :
         points_of(growth, kind, [](const GrowthPoint&) { return true; })) {
      const CostSample& sample = point->sample;
      rows.push_back(
          {kind, point->series, cli::counted(std::uint64_t(sample.triangles)),
           fmt::format("{}x{}", point->width, point->height), std::to_string(point->layers),
           fmt::format("{:.3g}", point->elongation), fmt::format("{:.2f}", 1e-6 * sample.fragments),
           fmt::format("{:.3f}", 1e-6 * sample.shaded_pixels), fmt::format("{:.3f}", sample.ms),
           fit == growth.fits.end() ? std::string()
                                    : fmt::format("{:+.0f} %", 100 * residual(fit->second, *point)),
           fmt::format("{:.1f} %", 100 * point->spread),
           fmt::format("{:.1f} %", 100 * point->aa_spread), std::to_string(point->round_ms.size()),
           std::to_string(point->unsettled_rounds)});
    }
  }
  using Column = HtmlPage::Column;
  page.table({{"soup", Column::text},
              {"grows", Column::text},
              {"triangles"},
              {"size"},
              {"layers"},
              {"width / height of a cell"},
              {"fragments / 10^6"},
              {"shaded / 10^6"},
              {"ms"},
              {"model off by"},
              {"spread"},
              {"A/A spread"},
              {"rounds"},
              {"of them begun unstable"}},
             rows);
}

constexpr const char* things[] = {"what every frame costs", "triangles", "fragments",
                                  "shaded pixels"};

/// What of an anchor's time goes where.
std::string dominance(const GrowthPoint& anchor, const CostFit& fit) {
  const CostSample& sample = anchor.sample;
  const double amounts[] = {1, sample.triangles, sample.fragments, sample.shaded_pixels};
  struct Part {
    const char* thing;
    double ms, error;
  };
  std::vector<Part> parts;
  for (std::size_t i = 0; i < std::size(amounts); ++i)
    parts.push_back({things[i], fit.ms[i] * amounts[i], fit.standard_error[i] * amounts[i]});
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.ms > b.ms; });
  const Part& first = parts.front();
  std::string others, ties;
  for (const Part& part : std::span(parts).subspan(1)) {
    others += fmt::format("{} {} {:.3g}", others.empty() ? "; then" : ",", part.thing, part.ms);
    // Two standard errors of a difference, which is at most the sum of both, however they
    // correlate.
    if (first.ms - part.ms <= 2 * (first.error + part.error))
      ties += fmt::format("{}{}", ties.empty() ? "" : " or ", part.thing);
  }
  return fmt::format(
      "by the model the largest part of a frame of {} is {}, {:.3g} of {:.3g} ms{}.{}",
      frame_text(anchor), first.thing, first.ms, fit.predict(sample), others,
      ties.empty() ? "" : " Within its errors that may as well be " + ties + ".");
}

std::string missed_points(const Growth& growth, const std::string& kind, const CostFit& fit) {
  std::vector<double> sizes;
  std::string missed;
  int doubtful = 0;
  for (const GrowthPoint* point : fitted_points(growth, kind)) {
    const double off = residual(fit, *point);
    sizes.push_back(std::abs(off));
    if (sizes.back() <= suspicious_residual) continue;
    if (sizes.back() <= 2 * noise(growth, *point))
      ++doubtful;
    else
      missed += fmt::format("{}{} ({}) by {:+.0f} %", missed.empty() ? "" : "; ", point->series,
                            frame_text(*point), 100 * off);
  }
  std::sort(sizes.begin(), sizes.end());
  std::string line = fmt::format("the model is off by {:.0f} % in the middle and {:.0f} % at most",
                                 100 * sizes[sizes.size() / 2], 100 * sizes.back());
  if (!missed.empty()) line += ", by more than 20 % and more than twice the spread at: " + missed;
  if (doubtful)
    line += fmt::format("; at {} more than 20 % are within twice the spread",
                        doubtful == 1 ? "1 point" : fmt::format("{} points", doubtful));
  return line + ".";
}

Verdict verdict_on_points(const Growth& growth, const GrowthPoint& a, const GrowthPoint& b) {
  const auto statistics = [](const GrowthPoint& point) {
    FrameStatistics result;
    result.min_of_medians = point.sample.ms;
    result.spread = point.spread;
    result.rounds = int(point.round_ms.size());
    return result;
  };
  return verdict_on(statistics(a), statistics(b), std::max(noise(growth, a), noise(growth, b)));
}

/// Whether edges cost; nothing where only one shape was timed.
std::string edges(const Growth& growth, const std::string& kind) {
  const Points shapes =
      points_of(growth, kind, [](const GrowthPoint& point) { return point.series == "shape"; });
  if (shapes.size() < 2) return {};
  const GrowthPoint& compact = *shapes.front();
  std::string others;
  for (const GrowthPoint* shape : std::span(shapes).subspan(1))
    others += fmt::format("{} {:.3g} times as long {:.3g} ms ({:+.0f} %)",
                          others.empty() ? "" : ",", shape->elongation, shape->sample.ms,
                          100 * (shape->sample.ms / compact.sample.ms - 1));
  const auto conclusion = [](Verdict verdict) {
    switch (verdict) {
      case Verdict::slower:
        return "longer edges cost, of which the model knows nothing";
      case Verdict::faster:
        return "frames with longer edges took less time, which the model does not explain";
      case Verdict::equal:
        return "what longer edges cost is within twice the spread";
      case Verdict::unknown:
        break;
    }
    return "too few rounds to say whether longer edges cost";
  };
  return fmt::format(
      "in cells as long as high a frame of {} takes {:.3g} ms, one of as many triangles and "
      "fragments in cells{}: {}.",
      frame_text(compact), compact.sample.ms, others,
      conclusion(verdict_on_points(growth, *shapes.back(), compact)));
}

std::string anchors_text(const Growth& growth, const std::string& kind) {
  const Points anchors = anchors_of(growth, kind);
  if (anchors.size() < 2) return {};
  const auto [low, high] = std::minmax_element(
      anchors.begin(), anchors.end(),
      [](const GrowthPoint* a, const GrowthPoint* b) { return a->sample.ms < b->sample.ms; });
  return fmt::format(
      "the frame that every series has ({}) takes {:.3g} to {:.3g} ms in its {} places, {:.1f} % "
      "apart; its slowest round took {:.1f} % longer than its quickest, by which no time is "
      "divided.",
      frame_text(*anchors.front()), (*low)->sample.ms, (*high)->sample.ms, anchors.size(),
      100 * anchor_spread(growth, kind), 100 * anchor_drift(growth, kind));
}

}  // namespace

void take_times(GrowthPoint& point, const FrameTimes& times) {
  assert(times.rounds() >= std::size_t(least_rounds));
  const FrameStatistics statistics = statistics_of(times);
  point.sample.ms = statistics.min_of_medians;
  point.p95_ms = statistics.p95;
  point.spread = statistics.spread;
  point.round_ms.clear();
  for (std::size_t i = 0; i < times.rounds(); ++i) point.round_ms.push_back(median(times.round(i)));
  FrameTimes halves[2] = {{.views = times.views, .ms = {}}, {.views = times.views, .ms = {}}};
  for (std::size_t i = 0; i < times.rounds() / 2 * 2; ++i) {
    const std::span<const double> round = times.round(i);
    halves[i % 2].ms.insert(halves[i % 2].ms.end(), round.begin(), round.end());
  }
  point.aa_spread = series_spread(halves[0], halves[1]);
}

double anchor_spread(const Growth& growth, const std::string& kind) {
  std::vector<double> ms;
  for (const GrowthPoint* anchor : anchors_of(growth, kind)) ms.push_back(anchor->sample.ms);
  return above_smallest(ms);
}

double noise(const Growth& growth, const GrowthPoint& point) {
  return std::max({point.spread, point.aa_spread, anchor_spread(growth, point.kind)});
}

void fit(Growth& growth) {
  for (const char* kind : kinds) {
    std::vector<CostSample> samples;
    for (const GrowthPoint* point : fitted_points(growth, kind)) samples.push_back(point->sample);
    if (std::optional<CostFit> found = fit_costs(samples)) growth.fits[kind] = std::move(*found);
  }
}

std::string point_line(const GrowthPoint& point) {
  return fmt::format(
      "{:<8} {:<10} {:>9} triangles, {:>2} layers, {}x{}, cells {:.3g} times as long as high: "
      "{:.3f} ms (spread {:.1f} %, A/A {:.1f} %, {} rounds{})",
      point.kind, point.series, cli::counted(std::uint64_t(point.sample.triangles)), point.layers,
      point.width, point.height, point.elongation, point.sample.ms, 100 * point.spread,
      100 * point.aa_spread, point.round_ms.size(),
      point.unsettled_rounds ? fmt::format(", {} begun unstable", point.unsettled_rounds) : "");
}

std::vector<std::string> explanation(const Growth& growth) {
  std::vector<std::string> lines;
  for (const char* kind : kinds) {
    const auto say = [&](const std::string& sentence) {
      if (!sentence.empty()) lines.push_back(fmt::format("{}: {}", kind, sentence));
    };
    if (const auto found = growth.fits.find(kind); found == growth.fits.end()) {
      say("the measurements do not tell the costs apart");
    } else {
      const CostFit& fit = found->second;
      // A negative cost means that it cannot be told from none: said by its standard error.
      const auto cost = [&](std::size_t i, double unit) {
        return fmt::format("{:.3g} +- {:.2g}", unit * fit.ms[i], unit * fit.standard_error[i]);
      };
      say(fmt::format(
          "a frame costs {} ms, a triangle {} ns, a fragment {} ns, a shaded pixel {} ns.",
          cost(0, 1), cost(1, 1e6), cost(2, 1e6), cost(3, 1e6)));
      if (const Points anchors = anchors_of(growth, kind); !anchors.empty())
        say(dominance(*anchors.front(), fit));
      say(missed_points(growth, kind, fit));
    }
    say(edges(growth, kind));
    say(anchors_text(growth, kind));
  }
  return lines;
}

void write_growth(const Growth& growth, const fs::path& folder) {
  write_file(folder / "growth.json",
             to_json(growth).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  HtmlPage page("How the time of a frame grows");
  page.paragraph(
      "Layers behind each other fill 64 % of the picture. One thing grows at a time: triangles, "
      "pixels, layers; in the series \"shape\" cells grow longer, and so edges alone. Round by "
      "round "
      "all points of a kind take turns; times are the smallest of the rounds' medians. The model t "
      "= "
      "a + b triangles + c fragments + d shaded pixels is fitted to all but \"shape\", kind by "
      "kind, "
      "by least squares of the relative error; fragments are those that rasterising every triangle "
      "makes, before the depth test and before any is discarded.");
  page.list(explanation(growth));
  std::vector<cli::Figure> figures;
  const std::string device = " " + device_of(growth) + ".";
  for (const Axis& axis : axes) {
    if (std::none_of(growth.points.begin(), growth.points.end(),
                     [&](const GrowthPoint& point) { return point.series == axis.series; }))
      continue;
    figures.push_back(
        {fmt::format("growth-{}", axis.series),
         fmt::format("Time against {}, bars up to the 95th percentile.", axis.series) + device,
         series_plot(growth, axis)});
  }
  if (!growth.fits.empty())
    figures.push_back(
        {"growth-fit", "The model against what was measured." + device, fit_plot(growth)});
  if (const auto drawn = cli::write_figures(figures, folder)) {
    for (const cli::DrawnFigure& figure : *drawn) page.drawing(figure.svg, figure.caption);
  } else {
    page.paragraph(cli::gnuplot_missing);
    cli::say(cli::gnuplot_missing);
  }
  add_table(page, growth);
  page.facts({{"renderer", device_of(growth)},
              {"context", growth.context},
              {"processor", growth.cpu},
              {"commit", growth.commit}});
  write_file(folder / "growth.html", page.text());
  cli::say("wrote " + (folder / "growth.html").string());
}

}  // namespace tureen::test
