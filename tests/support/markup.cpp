#include "support/markup.hpp"

#include <algorithm>
#include <cctype>
#include <regex>

namespace tureen::test {

namespace {

class Checker {
 public:
  explicit Checker(const std::string& document) : rest_(document) {}

  Markup run() {
    skip_declaration("<?xml");
    skip_declaration("<!DOCTYPE");
    while (at_ < rest_.size() && result_.defect.empty()) rest_[at_] == '<' ? tag() : text();
    if (result_.defect.empty() && !open_.empty()) fail("<" + open_.back() + "> is never closed");
    static const std::regex style_link("url\\(([^)]*)\\)|@import([^;]*)");
    for (std::sregex_iterator it(rest_.begin(), rest_.end(), style_link), end; it != end; ++it)
      result_.links.push_back((*it)[1].matched ? (*it)[1] : (*it)[2]);
    return result_;
  }

 private:
  void fail(const std::string& reason) {
    if (result_.defect.empty())
      result_.defect = reason + " at byte " + std::to_string(at_) + ": " + rest_.substr(at_, 40);
  }
  bool begins(const std::string& word) const { return rest_.compare(at_, word.size(), word) == 0; }
  void blanks() {
    while (at_ < rest_.size() && std::isspace(static_cast<unsigned char>(rest_[at_]))) ++at_;
  }
  void skip_declaration(const std::string& word) {
    blanks();
    if (begins(word)) at_ = rest_.find('>', at_) + 1;
    blanks();
  }

  std::string name() {
    const std::size_t begin = at_;
    while (at_ < rest_.size() && (std::isalnum(static_cast<unsigned char>(rest_[at_])) ||
                                  rest_[at_] == '-' || rest_[at_] == ':'))
      ++at_;
    if (at_ == begin) fail("a name is missing");
    return rest_.substr(begin, at_ - begin);
  }

  void text() {
    const std::size_t end = std::min(rest_.find('<', at_), rest_.size());
    references(end);
    if (open_.empty() && rest_.find_first_not_of(" \n\t", at_) < end) fail("text outside");
    result_.text.append(rest_, at_, end - at_);
    at_ = end;
  }
  /// Every & begins a reference.
  void references(std::size_t end) {
    static const std::regex reference("&(amp|lt|gt|quot|#39);");
    for (std::size_t i = rest_.find('&', at_); i < end; i = rest_.find('&', i + 1))
      if (!std::regex_search(rest_.begin() + std::ptrdiff_t(i), rest_.end(), reference,
                             std::regex_constants::match_continuous))
        return fail("a stray &");
  }

  void tag() {
    ++at_;
    if (begins("/")) {
      ++at_;
      const std::string closed = name();
      blanks();
      if (open_.empty() || open_.back() != closed) return fail("</" + closed + "> closes nothing");
      open_.pop_back();
      return expect('>');
    }
    const std::string opened = name();
    if (open_.empty() && !result_.elements.empty()) fail("a second root");
    result_.elements.push_back(opened);
    std::vector<std::string> attributes;
    for (blanks(); result_.defect.empty() && !begins(">") && !begins("/>"); blanks())
      attribute(attributes);
    if (begins("/")) {
      ++at_;
    } else {
      open_.push_back(opened);
    }
    expect('>');
  }

  void attribute(std::vector<std::string>& seen) {
    const std::string key = name();
    if (std::find(seen.begin(), seen.end(), key) != seen.end()) fail("a second " + key);
    seen.push_back(key);
    blanks();
    expect('=');
    blanks();
    const char quote = at_ < rest_.size() ? rest_[at_] : '\0';
    if (quote != '"' && quote != '\'') return fail("a value without quotes");
    const std::size_t end = rest_.find(quote, ++at_);
    if (end == std::string::npos) return fail("a value without an end");
    const std::string value = rest_.substr(at_, end - at_);
    if (value.find('<') != std::string::npos) fail("a < in a value");
    references(end);
    if (key == "href" || key == "src" || key == "xlink:href") result_.links.push_back(value);
    if (key == "id") result_.identifiers.push_back(value);
    at_ = end + 1;
  }
  void expect(char c) {
    if (at_ < rest_.size() && rest_[at_] == c)
      ++at_;
    else
      fail(std::string("no '") + c + "'");
  }

  const std::string& rest_;
  std::size_t at_ = 0;
  std::vector<std::string> open_;
  Markup result_;
};

}  // namespace

Markup check_markup(const std::string& document) { return Checker(document).run(); }

}  // namespace tureen::test
