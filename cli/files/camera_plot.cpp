#include "cli/files/camera_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <utility>

namespace tureen::cli {

namespace {

constexpr double panel_side = 460, panel_top = 60, gap = 26.66;

/// The axes of the plot in world coordinates.
struct PlotAxes {
  glm::dvec3 right, ahead, up;

  explicit PlotAxes(glm::dvec3 up_axis) : up(glm::normalize(up_axis)) {
    // Of a dataset with z up, the view from above has x to the right and y upwards.
    const glm::dvec3 x = std::abs(up.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    right = glm::normalize(x - up * glm::dot(x, up));
    ahead = glm::cross(up, right);
  }
  glm::dvec3 of(glm::dvec3 v) const {
    return {glm::dot(v, right), glm::dot(v, ahead), glm::dot(v, up)};
  }
};

class CameraPlot {
 public:
  explicit CameraPlot(const DatasetSummary& dataset) : dataset_(dataset), axes_(dataset.up) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const auto* views : {&dataset.train, &dataset.test})
      for (const DatasetSummary::View& view : *views) {
        const glm::dvec3 place = axes_.of(view.camera.eye());
        low = glm::min(low, place);
        high = glm::max(high, place);
      }
    center_ = 0.5 * (low + high);
    const glm::dvec3 size = high - low;
    // A margin for the lines; a single camera has a panel of two units.
    const double largest = std::max({size.x, size.y, size.z});
    half_ = largest > 0 && std::isfinite(largest) ? 0.65 * largest : 1.0;
  }

  std::string text() {
    put("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1000 560\" "
        "font-family=\"sans-serif\" font-size=\"15\">\n"
        "<rect width=\"1000\" height=\"560\" fill=\"#fff\"/>\n");
    panel("from above", 0, 1);
    panel("from the side", 1, 2);
    legend();
    put("</svg>\n");
    return std::move(svg_);
  }

 private:
  template <class... Values>
  void put(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(svg_), format, std::forward<Values>(values)...);
  }

  /// In user units within a panel, y down.
  glm::dvec2 placed(glm::dvec3 axes_position, int vertical) const {
    const glm::dvec3 relative = (axes_position - center_) / half_;
    return {0.5 * panel_side * (1 + relative.x), 0.5 * panel_side * (1 - relative[vertical])};
  }

  void panel(const char* title, int column, int vertical) {
    const double left = gap + column * (panel_side + gap);
    put("<svg x=\"{:.2f}\" y=\"{:.2f}\" width=\"{}\" height=\"{}\">\n", left, panel_top, panel_side,
        panel_side);
    put("<rect width=\"100%\" height=\"100%\" fill=\"#f7f7f7\" stroke=\"#bbb\"/>\n");
    put("<g fill=\"#999\">\n");
    constexpr std::size_t most = 4000;
    const std::size_t all = dataset_.points.size(), shown = std::min(all, most);
    for (std::size_t i = 0; i < shown; ++i) {
      const glm::dvec2 p = placed(axes_.of(dataset_.points[i * all / shown].position), vertical);
      if (p.x >= 0 && p.y >= 0 && p.x <= panel_side && p.y <= panel_side)
        put("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"0.8\"/>\n", p.x, p.y);
    }
    put("</g>\n");
    views(dataset_.train, train_color, vertical);
    views(dataset_.test, test_color, vertical);
    put("</svg>\n<text x=\"{:.2f}\" y=\"{:.2f}\">{}</text>\n", left, panel_top - 10, title);
  }

  void views(const std::vector<DatasetSummary::View>& views, const char* color, int vertical) {
    put("<g fill=\"{0}\" stroke=\"{0}\">\n", color);
    for (const DatasetSummary::View& view : views) {
      const glm::dvec3 eye = view.camera.eye();
      const glm::dvec3 forward = -view.camera.world_from_view_rotation()[2];
      const glm::dvec2 from = placed(axes_.of(eye), vertical);
      const glm::dvec2 to = placed(axes_.of(eye + 0.1 * half_ * forward), vertical);
      put("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>"
          "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.5\"/>\n",
          from.x, from.y, to.x, to.y, from.x, from.y);
    }
    put("</g>\n");
  }

  void legend() {
    put("<circle cx=\"{}\" cy=\"18\" r=\"4\" fill=\"{}\"/><text x=\"{}\" y=\"23\">{} to train "
        "on</text>\n",
        gap + 4, train_color, gap + 14, dataset_.train.size());
    put("<circle cx=\"204\" cy=\"18\" r=\"4\" fill=\"{}\"/><text x=\"214\" y=\"23\">{} to "
        "test</text>\n",
        test_color, dataset_.test.size());
    // The largest of 1, 2 and 5 times a power of ten that a quarter of a panel holds.
    const double quarter = 0.5 * half_, power = std::pow(10.0, std::floor(std::log10(quarter)));
    const double length = power * (quarter >= 5 * power ? 5 : quarter >= 2 * power ? 2 : 1);
    const double bar = 0.5 * panel_side * length / half_;
    put("<path d=\"M{0:.2f} 536h{1:.2f}\" stroke=\"#000\" stroke-width=\"2\"/>"
        "<text x=\"{2:.2f}\" y=\"541\">{3:g} units</text>\n",
        gap, bar, gap + bar + 8, length);
  }

  static constexpr const char* train_color = "#1f6fb4";
  static constexpr const char* test_color = "#e07b00";

  const DatasetSummary& dataset_;
  PlotAxes axes_;
  glm::dvec3 center_{};
  double half_ = 1;  // of a panel's side, in world units
  std::string svg_;
};

}  // namespace

std::string camera_plot(const DatasetSummary& dataset) { return CameraPlot(dataset).text(); }

}  // namespace tureen::cli
