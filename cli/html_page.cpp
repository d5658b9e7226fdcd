#include "cli/html_page.hpp"

#include <cassert>

#include "cli/base64.hpp"
#include "formats/utf8.hpp"

namespace tureen::cli {

namespace {

constexpr const char* style = R"(
:root{color-scheme:light dark;--page:#ffffff;--ink:#1f2328;--faint:#636c76;--line:#d9dee3;--tint:#f4f6f8}
@media(prefers-color-scheme:dark){:root{--page:#0d1117;--ink:#e6edf3;--faint:#9198a1;--line:#30363d;--tint:#161b22}}
body{margin:0 auto;padding:1.5rem 1rem 4rem;max-width:64rem;background:var(--page);color:var(--ink);font:16px/1.5 system-ui,-apple-system,'Segoe UI','DejaVu Sans',sans-serif}
h1{font-size:1.6rem;line-height:1.25}h2{font-size:1.2rem;margin-top:2.2rem}
p,li{max-width:46rem}
.scroll{overflow-x:auto;margin:1rem 0}
table{border-collapse:collapse;font-size:.875rem}
th,td{padding:.3rem .7rem;border-bottom:1px solid var(--line);text-align:left;vertical-align:top}
th{color:var(--faint);font-weight:600}
thead th{white-space:nowrap}
.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}
tbody tr:nth-child(even){background:var(--tint)}
pre{background:var(--tint);padding:.7rem;overflow-x:auto;font-size:.875rem}
figure{margin:1.2rem 0}figcaption{color:var(--faint);font-size:.875rem}
figure img{max-width:100%;height:auto}
details{margin:.8rem 0}summary{cursor:pointer;color:var(--faint)}
)";

std::string element(const char* name, const std::string& text) {
  return std::string("<") + name + ">" + html_escaped(text) + "</" + name + ">\n";
}

std::string caption_of(const std::string& caption) {
  return caption.empty() ? std::string() : element("figcaption", caption);
}

}  // namespace

std::string html_escaped(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    const auto [code, length] = utf8_character(text, i);
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else if (c == '\'')
      result += "&#39;";
    else if (length == 0 || (code < 0x20 && c != '\t' && c != '\n') || code == 0x7f ||
             code == 0xfffe || code == 0xffff)
      result += "\xef\xbf\xbd";
    else
      result.append(text, i, length);
    i += length ? length : 1;
  }
  return result;
}

HtmlPage::HtmlPage(std::string title) : title_(std::move(title)) { body_ = element("h1", title_); }

void HtmlPage::section(const std::string& heading) { body_ += element("h2", heading); }

void HtmlPage::paragraph(const std::string& text) { body_ += element("p", text); }

void HtmlPage::list(const std::vector<std::string>& items) {
  if (items.empty()) return;  // HTML has no empty lists
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += element("li", item);
  body_ += "</ul>\n";
}

void HtmlPage::command(const std::string& line) { body_ += element("pre", line); }

void HtmlPage::fold(const std::string& summary) {
  body_ += "<details>\n" + element("summary", summary);
}

void HtmlPage::fold_end() { body_ += "</details>\n"; }

void HtmlPage::table(const std::vector<Heading>& headings,
                     const std::vector<std::vector<std::string>>& rows) {
  const auto cell = [&](const char* name, std::size_t column, const std::string& text) {
    const bool number = headings[column].kind == Column::number;
    return std::string("<") + name + (number ? " class=\"n\">" : ">") + html_escaped(text) + "</" +
           name + ">";
  };
  body_ += "<div class=\"scroll\"><table><thead><tr>";
  for (std::size_t i = 0; i < headings.size(); ++i) body_ += cell("th", i, headings[i].name);
  body_ += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : rows) {
    assert(row.size() == headings.size());
    body_ += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) body_ += cell("td", i, row[i]);
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void HtmlPage::facts(const std::vector<std::pair<std::string, std::string>>& facts) {
  body_ += "<div class=\"scroll\"><table><tbody>\n";
  for (const auto& [name, text] : facts)
    body_ += "<tr><th scope=\"row\">" + html_escaped(name) + "</th><td>" + html_escaped(text) +
             "</td></tr>\n";
  body_ += "</tbody></table></div>\n";
}

void HtmlPage::drawing(const std::string& svg, const std::string& caption) {
  body_ += "<figure>\n" + svg + caption_of(caption) + "</figure>\n";
}

void HtmlPage::picture(std::span<const std::byte> png, const std::string& caption) {
  body_ += "<figure>\n<img alt=\"" + html_escaped(caption) + "\" src=\"data:image/png;base64," +
           base64(png) + "\"/>\n" + caption_of(caption) + "</figure>\n";
}

std::string HtmlPage::text() const {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n" +
         element("title", title_) + "<style>" + style + "</style>\n</head>\n<body>\n" + body_ +
         "</body>\n</html>\n";
}

}  // namespace tureen::cli
