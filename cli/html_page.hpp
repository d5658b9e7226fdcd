// One HTML page that needs nothing beside it: no script, no font, no picture from elsewhere. For
// light and dark, for wide screens and phones. Its markup is XML, too, so that a small checker can
// prove it well-formed.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tureen::cli {

/// Text for elements and attributes of HTML and XML. What neither may hold (control characters,
/// bytes that are no UTF-8) becomes U+FFFD.
std::string html_escaped(const std::string& text);

/// All texts are escaped here; whoever calls passes them as they are.
class HtmlPage {
 public:
  explicit HtmlPage(std::string title);

  void section(const std::string& heading);
  void paragraph(const std::string& text);
  void list(const std::vector<std::string>& items);
  /// A line to be typed.
  void command(const std::string& line);
  /// What is behind it is shown when the reader asks; up to the next fold_end().
  void fold(const std::string& summary);
  void fold_end();

  enum class Column { text, number };  // numbers stand to the right, digits below digits
  struct Heading {
    std::string name;
    Column kind = Column::number;
  };
  /// Scrolls sideways by itself where the screen is narrow. Every row has as many cells as there
  /// are headings.
  void table(const std::vector<Heading>& headings,
             const std::vector<std::vector<std::string>>& rows);
  /// A name and what is said of it, line by line.
  void facts(const std::vector<std::pair<std::string, std::string>>& facts);

  /// An SVG as draw_plot() makes it, as it is: the one thing that is not escaped, so never from
  /// somebody else's hands.
  void drawing(const std::string& svg, const std::string& caption);
  /// A PNG, within the page.
  void picture(std::span<const std::byte> png, const std::string& caption);

  /// The whole page.
  std::string text() const;

 private:
  std::string title_;
  std::string body_;
};

}  // namespace tureen::cli
