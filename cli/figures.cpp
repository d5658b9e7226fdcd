#include "cli/figures.hpp"

#include "cli/interrupt.hpp"
#include "formats/output.hpp"

namespace tureen::cli {

std::optional<std::vector<DrawnFigure>> write_figures(std::span<const Figure> figures,
                                                      const std::filesystem::path& folder) {
  std::vector<DrawnFigure> drawn;
  for (const Figure& figure : figures) {
    throw_if_interrupted();
    const std::optional<std::string> svg = draw_plot(figure.plot, PlotFormat::svg);
    if (!svg) return std::nullopt;
    const std::string name = (folder / figure.file).string();
    write_file(name + ".svg", *svg);
    write_plot(figure.plot, name + ".png");
    drawn.push_back({*svg, figure.caption, {name + ".svg", name + ".png"}});
  }
  return drawn;
}

std::vector<std::string> files_of(std::span<const DrawnFigure> figures) {
  std::vector<std::string> files;
  for (const DrawnFigure& figure : figures)
    files.insert(files.end(), figure.files.begin(), figure.files.end());
  return files;
}

}  // namespace tureen::cli
