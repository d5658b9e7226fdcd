#include "bench/growth_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

std::vector<const GrowthPoint*> points_of(const Growth& growth, const std::string& kind) {
  std::vector<const GrowthPoint*> result;
  for (const GrowthPoint& point : growth.points)
    if (point.kind == kind) result.push_back(&point);
  return result;
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
    for (const GrowthPoint* point : points_of(growth, kind)) {
      if (point->series != axis.series) continue;
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
    for (const GrowthPoint* point : points_of(growth, kind))
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
  Json points = Json::array(), fits = Json::object();
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
                      {"aa_spread", point.aa_spread}});
  for (const auto& [kind, fit] : growth.fits)
    fits[kind] = {{"frame_ms", fit.ms[0]},
                  {"triangle_ns", 1e6 * fit.ms[1]},
                  {"fragment_ns", 1e6 * fit.ms[2]},
                  {"shaded_pixel_ns", 1e6 * fit.ms[3]},
                  {"standard_errors_ms", fit.standard_error},
                  {"residuals", fit.residuals}};
  return {{"format", "tureen growth"},
          {"version", 1},
          {"commit", growth.commit},
          {"cpu", growth.cpu},
          {"context", growth.context},
          {"renderer", growth.renderer},
          {"software", growth.software},
          {"processor_time", growth.processor_time},
          {"points", points},
          {"fits", fits}};
}

void add_table(HtmlPage& page, const Growth& growth) {
  std::vector<std::vector<std::string>> rows;
  for (const char* kind : kinds) {
    const auto fit = growth.fits.find(kind);
    const std::vector<const GrowthPoint*> points = points_of(growth, kind);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const CostSample& s = points[i]->sample;
      rows.push_back({kind, points[i]->series, cli::counted(std::uint64_t(s.triangles)),
                      fmt::format("{}x{}", points[i]->width, points[i]->height),
                      std::to_string(points[i]->layers), fmt::format("{:.2f}", 1e-6 * s.fragments),
                      fmt::format("{:.3f}", 1e-6 * s.shaded_pixels), fmt::format("{:.3f}", s.ms),
                      fit == growth.fits.end()
                          ? std::string()
                          : fmt::format("{:+.0f} %", 100 * fit->second.residuals[i]),
                      fmt::format("{:.1f} %", 100 * points[i]->aa_spread)});
    }
  }
  using Column = HtmlPage::Column;
  page.table({{"soup", Column::text},
              {"grows", Column::text},
              {"triangles"},
              {"size"},
              {"layers"},
              {"fragments / 10^6"},
              {"shaded / 10^6"},
              {"ms"},
              {"model off by"},
              {"A/A spread"}},
             rows);
}

}  // namespace

void fit(Growth& growth) {
  for (const char* kind : kinds) {
    std::vector<CostSample> samples;
    for (const GrowthPoint* point : points_of(growth, kind)) samples.push_back(point->sample);
    if (std::optional<CostFit> found = fit_costs(samples)) growth.fits[kind] = std::move(*found);
  }
}

std::string point_line(const GrowthPoint& point) {
  return fmt::format("{:<8} {:<10} {:>9} triangles, {:>2} layers, {}x{}: {:.3f} ms (A/A {:.1f} %)",
                     point.kind, point.series, cli::counted(std::uint64_t(point.sample.triangles)),
                     point.layers, point.width, point.height, point.sample.ms,
                     100 * point.aa_spread);
}

std::vector<std::string> explanation(const Growth& growth) {
  std::vector<std::string> lines;
  for (const char* kind : kinds) {
    const auto found = growth.fits.find(kind);
    if (found == growth.fits.end()) {
      lines.push_back(fmt::format("{}: the measurements do not tell the costs apart", kind));
      continue;
    }
    const CostFit& fit = found->second;
    const auto cost = [&](std::size_t i, double unit) {
      return fmt::format("{:.3g} +- {:.2g}", unit * fit.ms[i], unit * fit.standard_error[i]);
    };
    lines.push_back(fmt::format(
        "{}: a frame costs {} ms, a triangle {} ns, a fragment {} ns, a shaded pixel {} ns.", kind,
        cost(0, 1), cost(1, 1e6), cost(2, 1e6), cost(3, 1e6)));
    // A negative cost means that it cannot be told from none: said by its standard error.
    const std::vector<const GrowthPoint*> points = points_of(growth, kind);
    std::vector<double> sizes;
    std::string missed;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double residual = fit.residuals[i];
      sizes.push_back(std::abs(residual));
      if (sizes.back() > suspicious_residual)
        missed += fmt::format(
            "{}{} ({} triangles, {}x{}, {} layers) by {:+.0f} %", missed.empty() ? "" : "; ",
            points[i]->series, cli::counted(std::uint64_t(points[i]->sample.triangles)),
            points[i]->width, points[i]->height, points[i]->layers, 100 * residual);
    }
    std::sort(sizes.begin(), sizes.end());
    lines.push_back(
        fmt::format("{}: the model is off by {:.0f} % in the middle and {:.0f} % at most{}.", kind,
                    100 * sizes[sizes.size() / 2], 100 * sizes.back(),
                    missed.empty() ? std::string() : ", by more than 20 % at: " + missed));
  }
  return lines;
}

void write_growth(const Growth& growth, const fs::path& folder) {
  write_file(folder / "growth.json",
             to_json(growth).dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  HtmlPage page("How the time of a frame grows");
  page.paragraph(
      "Layers behind each other fill 64 % of the picture. One thing grows at a time: triangles, "
      "pixels, layers. The model t = a + b triangles + c fragments + d shaded pixels is fitted to "
      "all points of a kind by least squares of the relative error; fragments are those that "
      "rasterising every triangle makes, before the depth test and before any is discarded.");
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
