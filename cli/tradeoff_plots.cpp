#include "cli/tradeoff_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <utility>

namespace tureen::cli {

namespace {

/// The y value of an outcome, NaN where it has none.
using ErrorOf = std::function<double(std::size_t)>;

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void take(double value) {
    if (std::isnan(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// What times are told in, and what the axis says of it.
struct Abscissa {
  double unit_ms = 1;
  std::string text = "ms a frame, logarithmic; bars to the 95th percentile";
};

/// One plot in the making: data blocks and the clauses that draw them.
class Drawing {
 public:
  Drawing(const Panel& panel, ErrorOf error, Abscissa abscissa = {})
      : panel_(panel), error_(std::move(error)), abscissa_(std::move(abscissa)) {
    for (std::size_t i = 0; i < panel.outcomes.size(); ++i) {
      if (!is_shown(i)) continue;
      time_.take(time(i));
      time_.take(p95(i));
      db_.take(error_(i));
    }
  }

  void rule(double db, const std::string& name, int dash) {
    db_.take(db);
    clauses_.push_back(
        fmt::format("{} with lines dashtype {} linewidth 1.5 linecolor rgb "
                    "'#636c76' title {}",
                    db, dash, plot_text(fmt::format("{}, {:.1f} dB", name, db))));
  }

  void front(const std::vector<std::size_t>& front) {
    std::vector<std::vector<double>> rows;
    for (const std::size_t i : front) rows.push_back({time(i), error_(i)});
    if (rows.empty()) return;
    rows.push_back({time_.high * margin, rows.back()[1]});
    clauses_.push_back(add_data(rows) +
                       " using 1:2 with steps linewidth 1.5 linecolor rgb '#1f2328' title " +
                       plot_text("front"));
    for (const std::size_t i : front) label(i);
  }

  /// The colour of points, and gnuplot's numbers of a filled and a hollow shape.
  struct Mark {
    std::string color;
    int filled = 7, hollow = 6;  // circles
  };
  void points(const Mark& mark, const std::string& title,
              const std::vector<std::size_t>& outcomes) {
    std::vector<std::vector<double>> specialised, generic;
    for (const std::size_t i : outcomes) {
      (panel_.outcomes[i].method == Method::generic ? generic : specialised)
          .push_back({time(i), error_(i), time(i), std::max(p95(i), time(i))});
    }
    if (!specialised.empty())
      clauses_.push_back(
          add_data(specialised) + " using 1:2:3:4 with xerrorbars " + mark.color +
          fmt::format(" linewidth 1 pointtype {} pointsize 0.8 title ", mark.filled) +
          plot_text(title));
    if (!generic.empty())
      clauses_.push_back(add_data(generic) + " using 1:2 with points " + mark.color +
                         fmt::format(" linewidth 1 pointtype {} pointsize 0.7 ", mark.hollow) +
                         (specialised.empty() ? "title " + plot_text(title) : "notitle"));
  }

  std::string script(const std::string& ordinate) const {
    const double space = std::max(0.06 * (db_.high - db_.low), 0.5);
    std::string script = data_ + labels_;
    script += "set logscale x\n" + time_marks() + "set key outside right top reverse Left\n";
    script +=
        "set xlabel " + plot_text(abscissa_.text) + "\nset ylabel " + plot_text(ordinate) + "\n";
    script += fmt::format("set xrange [{}:{}]\nset yrange [{}:{}]\n", time_.low / margin,
                          time_.high * margin, db_.low - space, db_.high + space);
    script += "plot ";
    for (std::size_t i = 0; i < clauses_.size(); ++i)
      script += (i ? ", \\\n     " : "") + clauses_[i];
    return script + "\n";
  }

  bool is_shown(std::size_t i) const {
    return panel_.outcomes[i].has_time() && !std::isnan(error_(i));
  }

 private:
  static constexpr double margin = 1.15;  // of the range of times, beside the points
  static constexpr int most_ticks = 9;    // numbers that stand beside each other without touching

  double time(std::size_t i) const {
    return panel_.outcomes[i].ms.min_of_medians / abscissa_.unit_ms;
  }
  double p95(std::size_t i) const { return panel_.outcomes[i].ms.p95 / abscissa_.unit_ms; }

  std::string time_marks() const {
    if (!(time_.high > 0)) return "";
    return plot_ticks('x',
                      PlotAxis::logarithmic(time_.low / margin, time_.high * margin, most_ticks));
  }

  std::string add_data(const std::vector<std::vector<double>>& rows) {
    const std::string name = fmt::format("data{}", ++blocks_);
    data_ += plot_data(name, rows);
    return "$" + name;
  }

  void label(std::size_t i) {
    labels_ += fmt::format(
        "set label {} at {},{} left offset 0.6,-0.6 font ',10' textcolor rgb "
        "'#636c76'\n",
        plot_text(panel_.outcomes[i].name), time(i), error_(i));
  }

  const Panel& panel_;
  ErrorOf error_;
  Abscissa abscissa_;
  Extent time_, db_;
  std::string data_, labels_;
  std::vector<std::string> clauses_;
  int blocks_ = 0;
};

/// Line types 1..6 are the colours of knobs; more knobs than that share.
Drawing::Mark mark_of(std::size_t knob) {
  return {.color = fmt::format("linetype {}", knob % 6 + 1)};
}

/// Where a knob stands in `palette`, whose order gives the colours: those of all panels that are
/// shown beside each other. Every knob of a panel is in its palette.
std::size_t color_of(const tradeoff::Knob& knob, const std::vector<tradeoff::Knob>& palette) {
  const auto is_same = [&](const tradeoff::Knob& other) { return other.key == knob.key; };
  const auto found = std::find_if(palette.begin(), palette.end(), is_same);
  assert(found != palette.end());
  return std::size_t(found - palette.begin());
}

void add_points(Drawing& drawing, const Panel& panel, const std::vector<tradeoff::Knob>& palette) {
  std::vector<std::vector<std::size_t>> of_knob(panel.knobs.size());
  std::vector<std::size_t> defaults, published;
  const std::vector<std::optional<std::size_t>> dominant = dominant_knobs(panel);
  for (std::size_t i = 0; i < panel.outcomes.size(); ++i) {
    if (!drawing.is_shown(i)) continue;
    const Outcome& outcome = panel.outcomes[i];
    if (outcome.method == Method::published)
      published.push_back(i);
    else if (dominant[i])
      of_knob[*dominant[i]].push_back(i);
    else
      defaults.push_back(i);
  }
  for (std::size_t knob = 0; knob < of_knob.size(); ++knob)
    drawing.points(mark_of(color_of(panel.knobs[knob], palette)), panel.knobs[knob].title,
                   of_knob[knob]);
  // By their shapes, diamonds and triangles: beside the knobs' grey no other could be told apart.
  const std::string black = "linecolor rgb '#1f2328'";
  drawing.points({.color = black, .filled = 13, .hollow = 12}, "defaults", defaults);
  drawing.points({.color = black, .filled = 9, .hollow = 8}, "published pipeline", published);
}

ErrorOf render_error_of(const Panel& panel) {
  return [&panel](std::size_t i) { return panel.outcomes[i].error.psnr_db; };
}

ErrorOf model_error_of(const std::vector<std::optional<ModelError>>& list) {
  return [&list](std::size_t i) {
    return i < list.size() && list[i] ? list[i]->psnr_db : std::nan("");
  };
}

Figure drawing_plot(const TradeoffReport& report, const std::vector<tradeoff::Knob>& palette) {
  const Panel& panel = report.study.drawing;
  Drawing drawing(panel, render_error_of(panel));
  drawing.rule(panel.ideal.psnr_db, "R1: the reference in 8 bits", 2);
  if (report.study.published)
    drawing.rule(panel.outcomes[*report.study.published].error.psnr_db,
                 "R0: the published pipeline", 3);
  drawing.rule(report.limits.least_psnr_db, "the choice's limit", 4);
  drawing.front(panel.front);
  add_points(drawing, panel, palette);
  return {"drawing",
          fmt::format("E_render of drawing knobs, against the oracle {}. Filled: what the plan "
                      "draws; hollow: with nothing left out (--no-specialise).",
                      where_it_looks(report)),
          {.title = "E_render of drawing knobs against time",
           .script = drawing.script("PSNR against the oracle, dB"),
           .width = 960,
           .height = 520}};
}

Figure antialiasing_plot(const TradeoffReport& report, const std::vector<tradeoff::Knob>& palette) {
  const Panel& panel = report.study.antialiasing;
  Drawing drawing(panel, render_error_of(panel));
  drawing.rule(panel.ideal.psnr_db, "R1: the reference in 8 bits", 2);
  drawing.front(panel.front);
  add_points(drawing, panel, palette);
  return {"antialiasing",
          "E_render of antialiasing knobs, against the oracle's 8 x 8 samples a pixel.",
          {.title = "E_render of antialiasing knobs against time",
           .script = drawing.script("PSNR against 8 x 8 samples, dB")}};
}

Figure model_plot(const TradeoffReport& report, const std::vector<tradeoff::Knob>& palette) {
  const Panel& panel = report.study.drawing;
  Drawing drawing(panel, model_error_of(report.drawing_model));
  add_points(drawing, panel, palette);
  return {"model",
          "E_model of drawing knobs, against photographs: how good the trained model is, and how "
          "little of it a knob takes. Never to be compared with E_render.",
          {.title = "E_model of drawing knobs against time",
           .script = drawing.script("PSNR against photographs, dB")}};
}

Figure means_plot(const ScenesPanel& panel, const std::string& kind, std::size_t scenes) {
  const Panel& means = panel.means;
  Drawing drawing(
      means, render_error_of(means),
      {.unit_ms = means.outcomes.front().ms.min_of_medians,
       .text = "time relative to the defaults, logarithmic; bars to the 95th percentile"});
  drawing.rule(means.ideal.psnr_db, "R1: the reference in 8 bits", 2);
  if (const Outcome* published = published_of(panel))
    drawing.rule(published->error.psnr_db, "R0: the published pipeline", 3);
  drawing.front(means.front);
  add_points(drawing, means, means.knobs);
  return {
      "means-" + kind,
      fmt::format("E_render of {} knobs over {} scenes: geometric means of time relative to "
                  "each scene's defaults, and means of decibels, of what was measured of all.",
                  kind, scenes),
      {.title = fmt::format("E_render of {} knobs against time, means of {} scenes", kind, scenes),
       .script = drawing.script("PSNR, mean of the scenes, dB"),
       .width = 960,
       .height = 520}};
}

std::vector<Figure> plots_of(const TradeoffReport& report,
                             const std::vector<tradeoff::Knob>& drawing,
                             const std::vector<tradeoff::Knob>& antialiasing) {
  std::vector<Figure> plots{drawing_plot(report, drawing), antialiasing_plot(report, antialiasing)};
  if (report.model) plots.push_back(model_plot(report, drawing));
  return plots;
}

}  // namespace

std::vector<std::optional<std::size_t>> dominant_knobs(const Panel& panel) {
  // Of each setting of each knob, alone, in the star; panels of others' files may be large.
  std::map<std::pair<std::size_t, int>, double> alone;
  for (const Outcome& single : panel.outcomes) {
    if (single.departures() != 1) continue;
    for (std::size_t knob = 0; knob < single.configuration.size(); ++knob)
      if (const int setting = single.configuration[knob]; setting != 0) {
        double& psnr = alone.try_emplace({knob, setting}, single.error.psnr_db).first->second;
        psnr = std::min(psnr, single.error.psnr_db);
      }
  }
  std::vector<std::optional<std::size_t>> dominant(panel.outcomes.size());
  for (std::size_t i = 0; i < panel.outcomes.size(); ++i) {
    const tradeoff::Configuration& configuration = panel.outcomes[i].configuration;
    double worst = 0;
    for (std::size_t knob = 0; knob < configuration.size(); ++knob) {
      if (configuration[knob] == 0) continue;
      // Without its star, which a knob that cannot be turned alone lacks, it is the last to blame.
      const auto star = alone.find({knob, configuration[knob]});
      const double psnr = star == alone.end() ? 100 : star->second;
      if (dominant[i] && psnr >= worst) continue;
      dominant[i] = knob;
      worst = psnr;
    }
  }
  return dominant;
}

std::vector<Figure> tradeoff_plots(const TradeoffReport& report) {
  return plots_of(report, report.study.drawing.knobs, report.study.antialiasing.knobs);
}

std::vector<Figure> means_plots(const TradeoffScenes& scenes) {
  return {means_plot(scenes.drawing, "drawing", scenes.runs.size()),
          means_plot(scenes.antialiasing, "antialiasing", scenes.runs.size())};
}

std::vector<Figure> scene_plots(const TradeoffScenes& scenes) {
  std::vector<Figure> plots;
  for (std::size_t r = 0; r < scenes.runs.size(); ++r)
    for (Figure& each : plots_of(scenes.runs[r].report, scenes.drawing.means.knobs,
                                 scenes.antialiasing.means.knobs)) {
      each.file = fmt::format("{}-{}", r + 1, each.file);
      each.caption = scenes.labels[r] + ": " + each.caption;
      each.plot.title += fmt::format(", {}: {}", r + 1, scenes.labels[r]);
      plots.push_back(std::move(each));
    }
  return plots;
}

}  // namespace tureen::cli
