#include "cli/report.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <string_view>
#include <variant>

#include "base/error.hpp"
#include "base/shown_text.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

namespace {

/// `indent` -1 prints one line.
void print(const Json& document, int indent) {
  const std::string text = json_text(document, indent);
  // JSON escapes only some of the characters that control a terminal. shown_text() escapes the
  // others, also in the syntax of JSON.
  std::string shown;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    shown += shown_text(std::string_view(text).substr(at, end - at)) + "\n";
    at = end + 1;
  }
  print_text(shown);
}

}  // namespace

std::string utc_now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

void print_text(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw OutputError({}, "standard output cannot be written");
}

namespace {
bool quiet = false;  // of the program, which has one command line
}

void be_quiet() { quiet = true; }
bool is_quiet() { return quiet; }

void say_error(const std::string& line) { std::fprintf(stderr, "%s\n", shown_line(line).c_str()); }

void say(const std::string& line) {
  if (!quiet) say_error(line);
}

void say_list(const std::string& heading, const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  say(heading);
  for (const std::string& line : lines) say("  " + line);
}

void print_json(const Json& document) { print(document, 2); }

namespace {

/// Appends a value to the remark's list of its type.
struct AddField {
  Json& json;

  void operator()(std::uint64_t count) const { json["counts"].push_back(count); }
  void operator()(double value) const { json["values"].push_back(value); }
  void operator()(const std::string& name) const { json["names"].push_back(name); }
  template <class T>
  void operator()(const std::vector<T>& values) const {
    for (const T& value : values) (*this)(value);
  }
};

}  // namespace

std::vector<std::string> notes_of(const std::vector<Remark>& remarks) {
  std::vector<std::string> notes;
  for (const Remark& remark : remarks) {
    std::string option = remark.kind->setting;
    std::replace(option.begin(), option.end(), '_', '-');
    notes.push_back(describe(remark) + (option.empty() ? "" : "; --" + option + " changes it"));
  }
  return notes;
}

std::vector<std::string> notes_of(const SceneInfo& info) {
  std::vector<std::string> notes = info.notes;
  for (std::string& note : notes_of(info.remarks)) notes.push_back(std::move(note));
  return notes;
}

Json remarks_json(const std::vector<Remark>& remarks) {
  Json list = Json::array();
  for (const Remark& remark : remarks) {
    Json& json = list.emplace_back(
        Json{{"kind", remark.kind->code}, {"severity", name_of(remark.kind->severity)}});
    for (const RemarkField& field : remark.fields) std::visit(AddField{json}, field.value);
    if (!remark.scene.empty()) json["scene"] = remark.scene;
  }
  return list;
}

void print_json_line(const Json& document) { print(document, -1); }

std::string bytes_text(std::uint64_t bytes) {
  if (bytes < 1024) return bytes == 1 ? "1 byte" : std::to_string(bytes) + " bytes";
  constexpr std::array units{"KiB", "MiB", "GiB", "TiB"};
  double value = double(bytes) / 1024;
  std::size_t unit = 0;
  while (value >= 1024 && unit + 1 < units.size()) {
    value /= 1024;
    ++unit;
  }
  return fmt::format("{:.{}f} {}", value, value < 10 ? 1 : 0, units[unit]);
}

std::string vector_text(const glm::dvec3& vector) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", vector.x, vector.y, vector.z);
}

}  // namespace tureen::cli
