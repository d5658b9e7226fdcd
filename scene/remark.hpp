// An assumption or loss while reading a file: a value that programs compare. describe() formats it
// as a sentence.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

namespace tureen {

/// What a remark is about. Each reader has a table of its kinds (formats/gltf/gltf_remarks.hpp).
struct RemarkKind {
  enum class Severity {
    note,        // nothing is lost
    assumption,  // the file does not say it, and it may be wrong
    loss,        // a part of the file is not drawn, or drawn differently
  };
  const char* code;  // in JSON: "polygons_split"
  Severity severity;
  /// An English sentence with named fields in braces: {field} is a value, {field:one|many} a word
  /// by its count, {field:and} a list such as "1, 2 and 5", {field:.2} a number with 2 decimal
  /// places, {field:%} a fraction in percent.
  const char* text;
  /// The setting that the reader assumed, such as "up"; "": none.
  const char* setting = "";
};

using RemarkValue = std::variant<std::uint64_t, double, std::string, std::vector<std::uint64_t>,
                                 std::vector<std::string>>;

/// A named part of a remark.
struct RemarkField {
  std::string_view name;  // a literal
  RemarkValue value;

  template <std::integral T>
  RemarkField(std::string_view field, T count) : name(field), value(std::uint64_t(count)) {}
  template <class T>
  RemarkField(std::string_view field, T given) : name(field), value(std::move(given)) {}

  bool operator==(const RemarkField&) const = default;
  friend bool operator<(const RemarkField& a, const RemarkField& b) {
    return std::tie(a.name, a.value) < std::tie(b.name, b.value);
  }
};

struct Remark {
  const RemarkKind* kind = nullptr;  // a constant
  std::vector<RemarkField> fields = {};
  /// Name of the scene, if several scenes were merged.
  std::string scene = {};

  bool operator==(const Remark&) const = default;
  /// An arbitrary total order, for sets. Browser toolchains lack <=> for vectors.
  friend bool operator<(const Remark& a, const Remark& b) {
    return std::tie(a.kind, a.fields, a.scene) < std::tie(b.kind, b.fields, b.scene);
  }
};

/// "note", "assumption" or "loss".
const char* name_of(RemarkKind::Severity severity);

/// A sentence in English.
std::string describe(const Remark& remark);
/// The sentences of all remarks.
std::vector<std::string> described(const std::vector<Remark>& remarks);

namespace remarks {
using Severity = RemarkKind::Severity;
}

}  // namespace tureen
