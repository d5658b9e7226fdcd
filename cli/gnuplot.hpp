// Plots by gnuplot, a program that is asked for when it is needed: where it is missing there are no
// plots, and all else works. The script reaches it through standard input and the picture comes
// back through standard output, both files without a name: no shell reads a word of them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/plot_axis.hpp"

namespace tureen::cli {

/// A sentence for people, where draw_plot gave nothing.
inline constexpr const char* gnuplot_missing =
    "no plots: gnuplot is not installed (Debian and Ubuntu: gnuplot-nox)";

struct Plot {
  std::string title;   // for those who do not see the picture; `script` may set a title of its own
  std::string script;  // gnuplot's commands; text in them by plot_text(), data by plot_data()
  int width = 960;     // of the picture in pixels
  int height = 440;
};

enum class PlotFormat { svg, png };

/// The bytes of the picture, or nothing where gnuplot is missing. What every plot begins with is
/// there already: size, font, quiet axes and a grid, six colours that people who confuse red and
/// green tell apart as line types 1..6, no markup in texts. An SVG begins with <svg, follows its
/// page into the dark, and has identifiers of its own, made of `title`, so that several stand in
/// one page. Throws OutputError with what gnuplot complains about.
std::optional<std::string> draw_plot(const Plot& plot, PlotFormat format);

/// Draws into a file, whole or not at all, .png or else SVG by its name; false where gnuplot is
/// missing. Throws OutputError.
bool write_plot(const Plot& plot, const std::filesystem::path& path);

/// `text` as a word of gnuplot's language: quoted so that nothing in it is a command.
std::string plot_text(const std::string& text);

/// The line that marks axis 'x' or 'y' at the ticks of `axis` alone. On logarithmic axes gnuplot
/// itself marks decades, of which there may be one or none between the least and the most.
std::string plot_ticks(char name, const PlotAxis& axis);

/// Lower-case letters and digits of `text` with '-' between them: for files.
std::string plot_identifier(const std::string& text);

/// The lines that define the data $NAME: a row a line, numbers with all digits; what is not finite
/// is missing. An empty row, a break in a line of the plot, stays. `name` is a word of letters,
/// digits and '_'.
std::string plot_data(const std::string& name, const std::vector<std::vector<double>>& rows);

}  // namespace tureen::cli
