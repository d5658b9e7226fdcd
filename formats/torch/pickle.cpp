#include "formats/torch/pickle.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <utility>

#include "base/shown_text.hpp"

namespace tureen {

namespace {

// The supported opcodes.
enum Opcode : unsigned char {
  op_mark = '(',
  op_stop = '.',
  op_binint = 'J',
  op_binint1 = 'K',
  op_binint2 = 'M',
  op_none = 'N',
  op_binpersid = 'Q',
  op_reduce = 'R',
  op_binunicode = 'X',
  op_append = 'a',
  op_build = 'b',
  op_global = 'c',
  op_appends = 'e',
  op_binget = 'h',
  op_long_binget = 'j',
  op_binput = 'q',
  op_long_binput = 'r',
  op_setitem = 's',
  op_tuple = 't',
  op_setitems = 'u',
  op_binfloat = 'G',
  op_empty_tuple = ')',
  op_empty_list = ']',
  op_empty_dict = '}',
  op_proto = 0x80,
  op_tuple1 = 0x85,
  op_tuple2 = 0x86,
  op_tuple3 = 0x87,
  op_newtrue = 0x88,
  op_newfalse = 0x89,
  op_long1 = 0x8a,
};

/// Names of rejected opcodes, for the message. Some of them build objects or call named functions.
constexpr std::pair<unsigned char, const char*> refused_opcodes[] = {
    {'0', "POP"},
    {'1', "POP_MARK"},
    {'2', "DUP"},
    {'F', "FLOAT"},
    {'I', "INT"},
    {'L', "LONG"},
    {'P', "PERSID"},
    {'S', "STRING"},
    {'T', "BINSTRING"},
    {'U', "SHORT_BINSTRING"},
    {'V', "UNICODE"},
    {'B', "BINBYTES"},
    {'C', "SHORT_BINBYTES"},
    {'d', "DICT"},
    {'g', "GET"},
    {'i', "INST"},
    {'l', "LIST"},
    {'o', "OBJ"},
    {'p', "PUT"},
    {0x80, "PROTO"},
    {0x81, "NEWOBJ"},
    {0x82, "EXT1"},
    {0x83, "EXT2"},
    {0x84, "EXT4"},
    {0x8b, "LONG4"},
    {0x8c, "SHORT_BINUNICODE"},
    {0x8d, "BINUNICODE8"},
    {0x8e, "BINBYTES8"},
    {0x8f, "EMPTY_SET"},
    {0x90, "ADDITEMS"},
    {0x91, "FROZENSET"},
    {0x92, "NEWOBJ_EX"},
    {0x93, "STACK_GLOBAL"},
    {0x94, "MEMOIZE"},
    {0x95, "FRAME"},
    {0x96, "BYTEARRAY8"},
    {0x97, "NEXT_BUFFER"},
    {0x98, "READONLY_BUFFER"},
};

/// One run over the opcodes. Values lie in one vector and refer to each other by index, so that
/// neither deep nesting nor cycles can exhaust the stack or leak memory.
class Machine {
 public:
  using Kind = Pickle::Kind;
  using Value = Pickle::Value;
  using Ref = Pickle::Ref;

  Machine(const std::string& name, std::span<const std::byte> bytes,
          std::span<const std::string_view> globals, std::vector<Value>& values)
      : name_(name), bytes_(bytes), globals_(globals), values_(values) {}

  Ref run() {
    if (byte("the protocol") != op_proto) fail("not a pickle of protocol 2");
    if (const unsigned version = byte("the protocol"); version < 2 || version > 5)
      fail("a pickle of protocol " + std::to_string(version));
    for (;;) {
      opcode_at_ = at_;
      const unsigned char opcode = byte("an opcode");
      if (opcode == op_stop) break;
      step(opcode);
    }
    if (stack_.size() != 1 || !marks_.empty())
      fail("the pickle ends with " + std::to_string(stack_.size()) + " values, not one");
    return stack_.back();
  }

 private:
  void step(unsigned char opcode) {
    switch (opcode) {
      case op_mark:
        marks_.push_back(stack_.size());
        return;
      case op_none:
        return push({});
      case op_newtrue:
        return push({.kind = Kind::boolean, .integer = 1});
      case op_newfalse:
        return push({.kind = Kind::boolean});
      case op_binint:
        return push_integer(static_cast<std::int32_t>(little(4, "BININT")));
      case op_binint1:
        return push_integer(static_cast<std::int64_t>(little(1, "BININT1")));
      case op_binint2:
        return push_integer(static_cast<std::int64_t>(little(2, "BININT2")));
      case op_long1:
        return push_integer(long1());
      case op_binfloat:
        return push({.kind = Kind::real, .real = big_endian_double()});
      case op_binunicode: {
        const auto size = little(4, "BINUNICODE");
        return push({.kind = Kind::text, .text = std::string(take(size, "a text"))});
      }
      case op_empty_list:
        return push({.kind = Kind::list});
      case op_empty_dict:
        return push({.kind = Kind::dict});
      case op_empty_tuple:
        return push({.kind = Kind::tuple});
      case op_tuple:
        return push({.kind = Kind::tuple, .items = pop_to_mark()});
      case op_tuple1:
        return push({.kind = Kind::tuple, .items = pop(1)});
      case op_tuple2:
        return push({.kind = Kind::tuple, .items = pop(2)});
      case op_tuple3:
        return push({.kind = Kind::tuple, .items = pop(3)});
      case op_append:
        return extend(Kind::list, pop(1));
      case op_appends:
        return extend(Kind::list, pop_to_mark());
      case op_setitem:
        return extend(Kind::dict, pop(2));
      case op_setitems:
        return extend(Kind::dict, pop_to_mark());
      case op_binput:
        return put(little(1, "BINPUT"));
      case op_long_binput:
        return put(little(4, "LONG_BINPUT"));
      case op_binget:
        return get(little(1, "BINGET"));
      case op_long_binget:
        return get(little(4, "LONG_BINGET"));
      case op_global:
        return global();
      case op_reduce:
        return reduce();
      case op_build:
        pop(1);
        return;  // attributes of the value below; ignored
      case op_binpersid:
        return push({.kind = Kind::persistent, .items = pop(1)});
      default:
        refuse(opcode);
    }
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError({name_, opcode_at_, {}}, reason);
  }

  [[noreturn]] void refuse(unsigned char opcode) const {
    char code[8];
    std::snprintf(code, sizeof code, "0x%02x", opcode);
    const char* name = "unknown";
    for (const auto& [refused, its_name] : refused_opcodes)
      if (refused == opcode) name = its_name;
    fail(std::string("the pickle opcode ") + name + " (" + code +
         ") is not supported: rejected, nothing was executed");
  }

  std::string_view take(std::uint64_t count, const char* what) {
    if (count > bytes_.size() - at_) fail(std::string("the pickle ends within ") + what);
    const std::string_view taken(reinterpret_cast<const char*>(bytes_.data()) + at_,
                                 static_cast<std::size_t>(count));
    at_ += taken.size();
    return taken;
  }

  unsigned char byte(const char* what) { return static_cast<unsigned char>(take(1, what)[0]); }

  std::uint64_t little(std::size_t count, const char* what) {
    const std::string_view taken = take(count, what);
    std::uint64_t value = 0;
    for (std::size_t i = count; i-- > 0;) value = value << 8 | static_cast<unsigned char>(taken[i]);
    return value;
  }

  std::int64_t long1() {
    const std::size_t count = byte("LONG1");
    if (count > 8) fail("a LONG1 of " + std::to_string(count) + " bytes, at most 8 are read");
    if (count == 0) return 0;
    const std::uint64_t value = little(count, "LONG1");
    const unsigned unused = static_cast<unsigned>(64 - 8 * count);
    return static_cast<std::int64_t>(value << unused) >> unused;  // extends the sign
  }

  double big_endian_double() {
    const std::string_view taken = take(8, "BINFLOAT");
    std::uint64_t bits = 0;
    for (const char c : taken) bits = bits << 8 | static_cast<unsigned char>(c);
    double value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

  void push(Value value) {
    if (values_.size() >= Pickle::max_values)
      fail("over " + std::to_string(Pickle::max_values) + " values");
    value.byte = opcode_at_;
    stack_.push_back(static_cast<Ref>(values_.size()));
    values_.push_back(std::move(value));
  }

  void push_integer(std::int64_t value) { push({.kind = Kind::integer, .integer = value}); }

  /// Number of values above the last mark (or of all): an opcode can take only these.
  std::size_t available() const { return stack_.size() - (marks_.empty() ? 0 : marks_.back()); }

  std::vector<Ref> pop(std::size_t count) {
    if (count > available()) fail("the pickle takes a missing value");
    std::vector<Ref> taken(stack_.end() - static_cast<std::ptrdiff_t>(count), stack_.end());
    stack_.resize(stack_.size() - count);
    return taken;
  }

  std::vector<Ref> pop_to_mark() {
    if (marks_.empty()) fail("the pickle takes values down to a missing mark");
    std::vector<Ref> taken = pop(available());
    marks_.pop_back();
    return taken;
  }

  Value& top() {
    if (available() == 0) fail("the pickle uses a missing value");
    return values_[stack_.back()];
  }

  void extend(Kind kind, const std::vector<Ref>& items) {
    Value& target = top();
    if (target.kind != kind)
      fail(std::string("the pickle adds items to ") + kind_name(target.kind));
    if (kind == Kind::dict && items.size() % 2 != 0) fail("a key without a value");
    target.items.insert(target.items.end(), items.begin(), items.end());
  }

  void put(std::uint64_t index) {
    top();
    // Picklers number the memo from 0 upwards. The limit prevents a false index from requesting
    // memory.
    if (index >= Pickle::max_values) fail("memo " + std::to_string(index) + " is out of bounds");
    if (index >= memo_.size()) memo_.resize(static_cast<std::size_t>(index) + 1, unset);
    memo_[static_cast<std::size_t>(index)] = stack_.back();
  }

  void get(std::uint64_t index) {
    if (index >= memo_.size() || memo_[static_cast<std::size_t>(index)] == unset)
      fail("the pickle recalls memo " + std::to_string(index) + ", which was never set");
    stack_.push_back(memo_[static_cast<std::size_t>(index)]);
  }

  std::string_view line(const char* what) {
    const auto* begin = reinterpret_cast<const char*>(bytes_.data()) + at_;
    const auto* end = static_cast<const char*>(std::memchr(begin, '\n', bytes_.size() - at_));
    if (!end) fail(std::string("the pickle ends within ") + what);
    const std::string_view text = take(static_cast<std::uint64_t>(end - begin), what);
    ++at_;
    return text;
  }

  void global() {
    std::string full(line("a module's name"));
    full += '.';
    full += line("a global's name");
    if (full != ordered_dict && std::find(globals_.begin(), globals_.end(), full) == globals_.end())
      fail("the pickle needs the global " + shown_line(full) +
           ", which is not supported: rejected, nothing was executed");
    push({.kind = Kind::global, .text = std::move(full)});
  }

  void reduce() {
    std::vector<Ref> items = pop(2);
    const Value& callable = values_[items[0]];
    if (callable.kind != Kind::global || values_[items[1]].kind != Kind::tuple)
      fail(std::string("REDUCE of ") + kind_name(callable.kind) + " with " +
           kind_name(values_[items[1]].kind));
    if (callable.text != ordered_dict) {
      push({.kind = Kind::constructed, .items = std::move(items)});
      return;
    }
    // Its items follow by SETITEMS, as torch and Python 3 write them.
    if (!values_[items[1]].items.empty()) fail("collections.OrderedDict with arguments");
    push({.kind = Kind::dict});
  }

  static constexpr Ref unset = ~Ref(0);
  static constexpr std::string_view ordered_dict = "collections.OrderedDict";

  const std::string& name_;
  std::span<const std::byte> bytes_;
  std::span<const std::string_view> globals_;
  std::vector<Value>& values_;
  std::vector<Ref> stack_, memo_;
  std::vector<std::size_t> marks_;  // heights of the stack
  std::size_t at_ = 0;
  std::uint64_t opcode_at_ = 0;
};

}  // namespace

const char* kind_name(Pickle::Kind kind) {
  static constexpr const char* names[] = {
      "None",    "a boolean", "an integer", "a number",  "a text",    "a list",
      "a tuple", "a dict",    "a global",   "a storage", "an object",
  };
  return names[static_cast<std::size_t>(kind)];
}

Pickle::Pickle(std::string name, std::span<const std::byte> bytes,
               std::span<const std::string_view> globals, MemoryBudget budget)
    : name_(std::move(name)) {
  if (bytes.size() > max_bytes)
    throw InputError({name_}, "a pickle of " + std::to_string(bytes.size()) +
                                  " bytes, the limit is " + std::to_string(max_bytes));
  // An opcode creates at most one value and stores one index: on the stack, in the memo or among
  // the items of another value. All of these lie in vectors that double. Texts are parts of the
  // bytes.
  const std::uint64_t values = std::min<std::uint64_t>(bytes.size(), max_values);
  if (!budget.take(values, 3 * sizeof(Value)) || !budget.take(bytes.size(), 9 * sizeof(Ref) + 1))
    throw InputError({name_}, budget.refusal("the pickle"), max_memory_hint);
  root_ = Machine(name_, bytes, globals, values_).run();
}

const Pickle::Value* Pickle::find(const Value& dict, std::string_view key) const {
  if (dict.kind != Kind::dict) return nullptr;
  for (std::size_t i = dict.items.size(); i >= 2; i -= 2) {
    const Value& candidate = values_[dict.items[i - 2]];
    if (candidate.kind == Kind::text && candidate.text == key) return &values_[dict.items[i - 1]];
  }
  return nullptr;
}

void Pickle::fail(const Value& value, const std::string& reason, const std::string& hint) const {
  throw InputError({name_, value.byte, {}}, reason, hint);
}

}  // namespace tureen
