#include "scene/remark.hpp"

#include <algorithm>
#include <cassert>

#include "base/decimal_text.hpp"

namespace tureen {

namespace {

std::string text_of(std::uint64_t count) { return std::to_string(count); }
std::string text_of(double number) { return short_decimal(number, 6); }
std::string text_of(const std::string& text) { return text; }
template <class T>
std::string text_of(const std::vector<T>& values) {
  std::string text;
  for (const T& value : values) text += (text.empty() ? "" : ", ") + text_of(value);
  return text;
}

}  // namespace

const RemarkValue& Remark::operator[](std::string_view field) const {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const RemarkField& each) { return each.name == field; });
  assert(found != fields.end());
  return found->value;
}

std::string Remark::text(std::string_view field) const {
  return std::visit([](const auto& value) { return text_of(value); }, (*this)[field]);
}

const char* name_of(RemarkKind::Severity severity) {
  constexpr const char* names[] = {"note", "assumption", "loss"};
  return names[std::size_t(severity)];
}

std::string describe(const Remark& remark) {
  return (remark.scene.empty() ? "" : remark.scene + ": ") + remark.kind->text(remark);
}

std::vector<std::string> described(const std::vector<Remark>& remarks) {
  std::vector<std::string> sentences;
  for (const Remark& remark : remarks) sentences.push_back(describe(remark));
  return sentences;
}

std::string remarks::counted(std::uint64_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace tureen
