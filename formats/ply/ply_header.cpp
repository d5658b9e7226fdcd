#include "formats/ply/ply_header.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <set>

#include "base/decimal.hpp"

namespace tureen {

namespace {

constexpr std::size_t max_header = std::size_t(1) << 20;

struct TypeName {
  std::string_view name;
  PlyType type;
};
constexpr TypeName type_names[] = {
    {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
    {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
    {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
    {"float64", PlyType::float64}};

class HeaderReader {
 public:
  /// `whole`: whether `input` is the whole file, so that the elements must fit into it.
  HeaderReader(Input& input, bool whole) : input_(input), whole_(whole) {
    std::vector<char> bytes(
        static_cast<std::size_t>(std::min<std::uint64_t>(input.size(), max_header)));
    input_.seek(0);
    bytes.resize(input_.read_some(std::as_writable_bytes(std::span(bytes))));
    text_.assign(bytes.begin(), bytes.end());
    // A line ends with LF, before which a CR is a blank, or with CR if the first line does. Other
    // line ends are not searched for, because a body may begin with a line feed.
    const std::size_t first = text_.find_first_of("\r\n");
    if (first != std::string::npos && text_[first] == '\r' &&
        !(first + 1 < text_.size() && text_[first + 1] == '\n'))
      line_break_ = "\r";
  }

  PlyHeader read() {
    if (!next_line() || words_.size() != 1 || words_[0] != "ply")
      fail("does not begin with a line of 'ply'");
    if (!next_line_of_content() || words_[0] != "format")
      fail("'format' is expected after the first line");
    read_format();
    for (;;) {
      if (!next_line_of_content())
        fail(text_.size() < max_header ? "the header ends without 'end_header'"
                                       : "no 'end_header' within the first 1 MiB");
      if (words_[0] == "end_header") break;
      if (words_[0] == "element")
        read_element();
      else if (words_[0] == "property")
        read_property();
      else
        fail("'" + printable(words_[0]) + "' where element, property or end_header is expected");
    }
    expect_words(1, "end_header");
    header_.body = next_;
    header_.body_line = line_ + 1;
    if (whole_) check_sizes();
    return std::move(header_);
  }

 private:
  bool next_line() {
    if (next_ >= text_.size()) return false;
    const std::size_t end = text_.find(line_break_, next_);
    // The end of this line was not read.
    if (end == std::string::npos && text_.size() < input_.size()) return false;
    const std::string_view line = std::string_view(text_).substr(next_, end - next_);
    next_ = end == std::string::npos ? text_.size() : end + line_break_.size();
    ++line_;
    words_.clear();
    for (std::size_t i = 0; i < line.size();) {
      const std::size_t first = line.find_first_not_of(" \t\r", i);
      if (first == std::string_view::npos) break;
      i = std::min(line.find_first_of(" \t\r", first), line.size());
      words_.push_back(line.substr(first, i - first));
    }
    // Without its line break a last line may be cut short.
    return end != std::string::npos || (!words_.empty() && words_[0] != "end_header");
  }

  bool next_line_of_content() {
    while (next_line()) {
      if (words_.empty() || words_[0] == "obj_info") continue;
      if (words_[0] != "comment") return true;
      for (std::size_t i = 1; i < words_.size(); ++i)
        header_.comments.append(i > 1 ? " " : "").append(words_[i]);
      header_.comments += '\n';
    }
    return false;
  }

  void read_format() {
    expect_words(3, "format");
    if (words_[1] == "ascii")
      header_.encoding = PlyHeader::Encoding::ascii;
    else if (words_[1] == "binary_little_endian")
      header_.encoding = PlyHeader::Encoding::little_endian;
    else if (words_[1] == "binary_big_endian")
      header_.encoding = PlyHeader::Encoding::big_endian;
    else
      fail("the encoding '" + printable(words_[1]) + "' is unknown");
    if (words_[2] != "1.0") fail("PLY of version '" + printable(words_[2]) + "', not 1.0");
  }

  void read_element() {
    expect_words(3, "element");
    PlyElement element;
    element.name = words_[1];
    element.line = line_;
    if (!names_.insert(element.name).second)
      fail("a second element '" + printable(element.name) + "'");
    const std::string text(words_[2]);
    const Integer count = parse_integer(text.c_str());
    if (!count.end || *count.end != '\0')
      fail("'" + printable(text) + "' where the number of elements is expected");
    if (count.value < 0 || count.value > std::int64_t(std::numeric_limits<std::uint32_t>::max()))
      fail("the number of '" + printable(element.name) + "' elements, " + text +
           ", is outside 0..4294967295");
    element.count = static_cast<std::uint64_t>(count.value);
    header_.elements.push_back(std::move(element));
  }

  void read_property() {
    if (header_.elements.empty()) fail("a property before any element");
    PlyProperty property;
    if (words_.size() > 1 && words_[1] == "list") {
      expect_words(5, "property list");
      property.count_type = type(words_[2]);
      if (!is_integer(*property.count_type))
        fail("a list counted in '" + printable(words_[2]) + "', not in integers");
      property.type = type(words_[3]);
      property.name = words_[4];
    } else {
      expect_words(3, "property");
      property.type = type(words_[1]);
      property.name = words_[2];
    }
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType type(std::string_view name) {
    for (const TypeName& known : type_names)
      if (known.name == name) return known.type;
    fail("the type '" + printable(name) + "' is unknown");
  }

  /// Checks each element separately, so that no sum overflows: counts are below 2^32, and a header
  /// of less than 2^20 bytes has fewer than 2^17 properties of 8 bytes.
  void check_sizes() {
    const bool ascii = header_.encoding == PlyHeader::Encoding::ascii;
    for (const PlyElement& element : header_.elements) {
      const std::uint64_t least = element.count * element.min_bytes(ascii);
      // The last value of a text needs no separator.
      const std::uint64_t left = input_.size() - header_.body + (ascii ? 1 : 0);
      if (least > left)
        throw InputError({input_.name(), {}, element.line},
                         std::to_string(element.count) + " '" + printable(element.name) +
                             "' elements take at least " + std::to_string(least) +
                             " bytes, but only " + std::to_string(input_.size() - header_.body) +
                             " follow");
    }
  }

  void expect_words(std::size_t count, const char* what) {
    if (words_.size() < count) fail(std::string("a line of '") + what + "' that is cut short");
    if (words_.size() > count)
      fail("'" + printable(words_[count]) + "' after a line of '" + what + "'");
  }

  static std::string printable(std::string_view word) {
    std::string text(word.substr(0, 40));
    for (char& c : text)
      if (c < ' ' || c > '~') c = '.';
    return text;
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError({input_.name(), {}, std::max<std::uint64_t>(line_, 1)}, reason);
  }

  Input& input_;
  bool whole_;
  std::string text_;
  std::string line_break_ = "\n";
  std::size_t next_ = 0;
  std::uint64_t line_ = 0;
  std::vector<std::string_view> words_;  // of the current line
  std::set<std::string> names_;          // of all elements; a set, because a header may have many
  PlyHeader header_;
};

}  // namespace

std::optional<std::size_t> PlyElement::find(std::string_view property) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == property) return i;
  return {};
}

std::uint64_t PlyElement::min_bytes(bool ascii) const {
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += ascii ? 2 : size_of(property.count_type.value_or(property.type));
  return bytes;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
  for (const PlyElement& candidate : elements)
    if (candidate.name == element) return &candidate;
  return nullptr;
}

void fail_element(const Input& input, const PlyElement& element, const std::string& reason) {
  throw InputError({input.name(), {}, element.line}, "element '" + element.name + "' " + reason);
}

bool is_ply(std::span<const std::byte> head) {
  return head.size() >= 4 && std::memcmp(head.data(), "ply", 3) == 0 &&
         (head[3] == std::byte('\n') || head[3] == std::byte('\r'));
}

PlyHeader read_ply_header(Input& input) { return HeaderReader(input, true).read(); }

std::optional<PlyHeader> read_ply_beginning(Input& input) {
  std::string text(static_cast<std::size_t>(std::min<std::uint64_t>(input.size(), max_header)),
                   ' ');
  input.seek(0);
  text.resize(input.read_some(std::as_writable_bytes(std::span(text))));
  // A byte more than the line: with CR LF, the body begins after both.
  std::size_t last = text.find_first_of("\r\n");
  while (last != std::string::npos && text.compare(last + 1, 10, "end_header") != 0)
    last = text.find_first_of("\r\n", last + 1);
  const bool is_complete = last != std::string::npos && last + 13 <= text.size();
  if (!is_complete && text.size() < max_header) return std::nullopt;
  return HeaderReader(input, false).read();
}

}  // namespace tureen
