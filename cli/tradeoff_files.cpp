#include "cli/tradeoff_files.hpp"

#include "cli/interrupt.hpp"
#include "formats/output.hpp"

namespace tureen::cli {

Drawings write_plots(std::span<const TradeoffPlot> plots, const std::filesystem::path& folder,
                     std::vector<std::string>& output, std::vector<std::string>& notes) {
  Drawings drawings;
  for (const TradeoffPlot& each : plots) {
    throw_if_interrupted();
    const std::optional<std::string> svg = draw_plot(each.plot, PlotFormat::svg);
    if (!svg) {
      notes.emplace_back(gnuplot_missing);
      break;
    }
    const std::string name = (folder / each.file).string();
    write_file(name + ".svg", *svg);
    write_plot(each.plot, name + ".png");
    output.insert(output.end(), {name + ".svg", name + ".png"});
    drawings.emplace_back(*svg, each.caption);
  }
  return drawings;
}

}  // namespace tureen::cli
