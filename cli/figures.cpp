#include "cli/figures.hpp"

#include "cli/interrupt.hpp"
#include "formats/output.hpp"

namespace tureen::cli {

std::vector<DrawnFigure> write_figures(std::span<const Figure> figures,
                                       const std::filesystem::path& folder,
                                       std::vector<std::string>& written) {
  std::vector<DrawnFigure> drawn;
  for (const Figure& figure : figures) {
    throw_if_interrupted();
    const std::optional<std::string> svg = draw_plot(figure.plot, PlotFormat::svg);
    if (!svg) return {};
    const std::string name = (folder / figure.file).string();
    write_file(name + ".svg", *svg);
    write_plot(figure.plot, name + ".png");
    written.insert(written.end(), {name + ".svg", name + ".png"});
    drawn.push_back({*svg, figure.caption});
  }
  return drawn;
}

}  // namespace tureen::cli
