#include "scene/remark.hpp"

#include "base/decimal_text.hpp"

namespace tureen {

namespace {

struct ToText {
  std::string_view last_separator;  // between the last two values of a list

  std::string operator()(std::uint64_t count) const { return std::to_string(count); }
  std::string operator()(double number) const { return short_decimal(number, 6); }
  std::string operator()(const std::string& text) const { return text; }
  template <class T>
  std::string operator()(const std::vector<T>& values) const {
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (i > 0) text += i + 1 < values.size() ? ", " : last_separator;
      text += (*this)(values[i]);
    }
    return text;
  }
};

bool is_one(const RemarkValue& value) {
  if (const auto* list = std::get_if<std::vector<std::uint64_t>>(&value)) return list->size() == 1;
  if (const auto* list = std::get_if<std::vector<std::string>>(&value)) return list->size() == 1;
  return value == RemarkValue(std::uint64_t(1));
}

/// `format`: the part of {field:format} after the colon, or "".
std::string formatted(const RemarkValue& value, std::string_view format) {
  if (const std::size_t bar = format.find('|'); bar != format.npos)
    return std::string(is_one(value) ? format.substr(0, bar) : format.substr(bar + 1));
  if (format == "%") return fixed_decimal(100 * std::get<double>(value), 0) + "%";
  if (format.size() > 1 && format[0] == '.')
    return fixed_decimal(std::get<double>(value), format[1] - '0');
  return std::visit(ToText{format == "and" ? " and " : ", "}, value);
}

/// The text of {placeholder}. If the remark lacks its field, it keeps the braces: a test finds
/// them.
std::string filled(const Remark& remark, std::string_view placeholder) {
  const std::size_t colon = placeholder.find(':');
  for (const RemarkField& field : remark.fields)
    if (field.name == placeholder.substr(0, colon))
      return formatted(field.value, colon == placeholder.npos ? "" : placeholder.substr(colon + 1));
  return "{" + std::string(placeholder) + "}";
}

}  // namespace

const char* name_of(RemarkKind::Severity severity) {
  constexpr const char* names[] = {"note", "assumption", "loss"};
  return names[std::size_t(severity)];
}

std::string describe(const Remark& remark) {
  std::string sentence = remark.scene.empty() ? "" : remark.scene + ": ";
  std::string_view rest = remark.kind->text;
  for (std::size_t open = rest.find('{'); open != rest.npos; open = rest.find('{')) {
    const std::size_t close = rest.find('}', open);
    if (close == rest.npos) break;
    sentence += rest.substr(0, open);
    sentence += filled(remark, rest.substr(open + 1, close - open - 1));
    rest.remove_prefix(close + 1);
  }
  return sentence.append(rest);
}

std::vector<std::string> described(const std::vector<Remark>& remarks) {
  std::vector<std::string> sentences;
  for (const Remark& remark : remarks) sentences.push_back(describe(remark));
  return sentences;
}

}  // namespace tureen
