#include "cli/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cassert>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <memory>
#include <regex>
#include <string_view>

#include "cli/html_page.hpp"
#include "formats/extension.hpp"
#include "formats/output.hpp"
#include "soup/error.hpp"

extern char** environ;  // POSIX has it in no header

namespace tureen::cli {

namespace {

/// What a colour of the script becomes on a dark page. The first six are Okabe and Ito's.
struct Paint {
  const char* light;
  const char* dark;
};
constexpr std::array paints{
    Paint{"#0072b2", "#4db2ee"}, Paint{"#d55e00", "#ff8f40"}, Paint{"#009e73", "#2fcf9f"},
    Paint{"#b3578a", "#e59ac2"}, Paint{"#a87900", "#f0c040"}, Paint{"#555f6b", "#b4bfcc"},
    Paint{"#ffffff", "#0d1117"}, Paint{"#1f2328", "#e6edf3"}, Paint{"#636c76", "#9198a1"},
    Paint{"#e4e8ec", "#262c34"}, Paint{"black", "#e6edf3"}};
constexpr std::size_t line_types = 6;

std::string prelude(const Plot& plot, PlotFormat format) {
  std::string script =
      format == PlotFormat::svg
          ? fmt::format(
                "set terminal svg size {},{} fixed noenhanced font 'sans-serif,13' "
                "background '#ffffff'\n",
                plot.width, plot.height)
          : fmt::format(
                "set terminal pngcairo size {},{} noenhanced font 'sans-serif,10' "
                "background '#ffffff'\n",
                plot.width, plot.height);
  for (std::size_t i = 0; i < line_types; ++i)
    script += fmt::format("set linetype {} linecolor rgb '{}' linewidth 2 pointtype 7\n", i + 1,
                          paints[i].light);
  return script + fmt::format("set linetype cycle {}\n", line_types) +
         "set datafile missing 'NaN'\n"
         "set encoding utf8\n"
         "set border 3 linecolor rgb '#636c76'\n"
         "set tics nomirror textcolor rgb '#636c76'\n"
         "set grid linetype 1 linewidth 1 linecolor rgb '#e4e8ec'\n"
         "set title textcolor rgb '#1f2328'\n"
         "set key textcolor rgb '#1f2328'\n"
         "set xlabel textcolor rgb '#636c76'\n"
         "set ylabel textcolor rgb '#636c76'\n"
         "set pointsize 0.6\n"
         "set errorbars small\n"
         "set style fill solid 0.85 noborder\n";
}

// ---- The other program -------------------------------------------------------------------------

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

/// A file without a name, which is gone when it is closed, however this program ends.
File nameless_file() {
  File file(std::tmpfile());
  if (!file) throw OutputError({}, "no temporary file can be made for gnuplot");
  return file;
}

std::string contents(std::FILE* file) {
  std::rewind(file);
  std::string text;
  std::array<char, 65536> buffer;
  for (std::size_t got; (got = std::fread(buffer.data(), 1, buffer.size(), file)) > 0;)
    text.append(buffer.data(), got);
  return text;
}

struct Streams {
  std::FILE *in, *out, *err;
};

/// The exit status of gnuplot, 127 for one that a signal ended; nothing where there is none.
std::optional<int> run_gnuplot(const Streams& streams) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(streams.in), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(streams.out), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, fileno(streams.err), STDERR_FILENO);
  // -d: without the settings of whoever calls.
  std::string name = "gnuplot", defaults = "-d";
  char* const arguments[] = {name.data(), defaults.data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT || error == EACCES) return std::nullopt;
  if (error != 0) throw OutputError({}, "gnuplot cannot be started");
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) throw OutputError({}, "gnuplot was lost");
  return WIFEXITED(status) ? WEXITSTATUS(status) : 127;
}

// ---- SVG for pages -----------------------------------------------------------------------------

std::string replaced(const std::string& text, const char* pattern, const std::string& by) {
  return std::regex_replace(text, std::regex(pattern), by);
}

/// gnuplot writes rgb(  0, 114, 178); selectors want one spelling.
std::string with_hexadecimal_colors(const std::string& svg) {
  static const std::regex color("rgb\\( *(\\d+), *(\\d+), *(\\d+)\\)");
  std::string result;
  auto rest = svg.cbegin();
  for (std::sregex_iterator it(svg.begin(), svg.end(), color), end; it != end; ++it) {
    result.append(rest, (*it)[0].first);
    result += fmt::format("#{:02x}{:02x}{:02x}", std::stoi((*it)[1]), std::stoi((*it)[2]),
                          std::stoi((*it)[3]));
    rest = (*it)[0].second;
  }
  return result.append(rest, svg.cend());
}

/// Rules stand above the attributes that gnuplot writes.
std::string dark_rules() {
  std::string rules =
      "<style>svg.plot{max-width:100%;height:auto}@media(prefers-color-scheme:dark){";
  for (const Paint& paint : paints)
    for (const char* property : {"fill", "stroke", "color"})
      rules += fmt::format("svg.plot [{0}=\"{1}\"]{{{0}:{2}}}", property, paint.light, paint.dark);
  return rules + "}</style>\n";
}

std::string for_pages(const std::string& drawn, const std::string& title) {
  std::string svg = drawn.substr(std::min(drawn.find("<svg"), drawn.size()));
  svg = replaced(svg, "<title>[^<]*</title>|<desc>[^<]*</desc>", "");
  svg = with_hexadecimal_colors(svg);
  // A filter or a use finds its definition by "#name".
  const std::string own = "plot-" + plot_identifier(title) + "-";
  svg = replaced(svg, "( id=['\"])", "$1" + own);
  svg = replaced(svg, "(href='#|url\\(#)", "$1" + own);
  const std::size_t head = svg.find('>');
  if (head == std::string::npos) throw OutputError({}, "gnuplot drew no SVG");
  svg.insert(head + 1, "\n<title>" + html_escaped(title) + "</title>\n" + dark_rules());
  return svg.insert(4, " class=\"plot\" role=\"img\"");
}

}  // namespace

std::optional<std::string> draw_plot(const Plot& plot, PlotFormat format) {
  const File in = nameless_file(), out = nameless_file(), err = nameless_file();
  const std::string script = prelude(plot, format) + plot.script + "\n";
  if (std::fwrite(script.data(), 1, script.size(), in.get()) != script.size() ||
      std::fflush(in.get()) != 0 || lseek(fileno(in.get()), 0, SEEK_SET) != 0)
    throw OutputError({}, "the temporary file for gnuplot cannot be written");
  const std::optional<int> status = run_gnuplot({in.get(), out.get(), err.get()});
  if (!status) return std::nullopt;
  std::string picture = contents(out.get());
  if (*status != 0 || picture.empty())
    throw OutputError({}, "gnuplot failed: " + contents(err.get()).substr(0, 500));
  return format == PlotFormat::svg ? for_pages(picture, plot.title) : picture;
}

bool write_plot(const Plot& plot, const std::filesystem::path& path) {
  const PlotFormat format = extension_of(path) == ".png" ? PlotFormat::png : PlotFormat::svg;
  const std::optional<std::string> picture = draw_plot(plot, format);
  if (!picture) return false;
  Output output(path);
  output.write(*picture);
  output.commit();
  return true;
}

std::string plot_text(const std::string& text) {
  // Between double quotes a backslash and three octal digits are a byte, and nothing else is left
  // that could mean anything: no quote, backslash, backquote (a command) or @ (a macro). gnuplot
  // 5.4 does not read every text with doubled single quotes.
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f)
      result += ' ';
    else if (byte < 0x80 && !std::isalnum(byte) &&
             std::string_view(" .,:/()+-=_").find(c) == std::string_view::npos)
      result += fmt::format("\\{:03o}", byte);
    else
      result += c;
  }
  return result + "\"";
}

std::string plot_ticks(char name, const PlotAxis& axis) {
  std::string marks;
  for (const Tick& tick : axis.ticks())
    marks += fmt::format("{}{} {}", marks.empty() ? "" : ", ", plot_text(tick.label), tick.value);
  return fmt::format("set {}tics ({})\n", name, marks);
}

std::string plot_identifier(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && std::isalnum(byte))
      result += static_cast<char>(std::tolower(byte));
    else if (!result.empty() && result.back() != '-')
      result += '-';
  }
  if (!result.empty() && result.back() == '-') result.pop_back();
  return result.empty() ? "plot" : result;
}

std::string plot_data(const std::string& name, const std::vector<std::vector<double>>& rows) {
  for ([[maybe_unused]] const char c : name)
    assert(std::isalnum(static_cast<unsigned char>(c)) || c == '_');
  std::string text = "$" + name + " << END_OF_DATA\n";
  for (const std::vector<double>& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      text += (i ? " " : "") + (std::isfinite(row[i]) ? fmt::format("{}", row[i]) : "NaN");
    text += "\n";
  }
  return text + "END_OF_DATA\n";
}

}  // namespace tureen::cli
