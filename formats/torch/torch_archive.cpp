#include "formats/torch/torch_archive.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

namespace tureen {

namespace {

// Storages are little endian and are read without conversion.
static_assert(std::endian::native == std::endian::little);

using Type = TorchTensor::Type;
using Kind = Pickle::Kind;
using Value = Pickle::Value;

struct StorageType {
  std::string_view global;
  Type type;
  std::size_t element_size;
};

constexpr StorageType storage_types[] = {
    {"torch.FloatStorage", Type::f32, 4}, {"torch.DoubleStorage", Type::f64, 8},
    {"torch.HalfStorage", Type::f16, 2},  {"torch.BFloat16Storage", Type::bf16, 2},
    {"torch.ByteStorage", Type::u8, 1},   {"torch.BoolStorage", Type::u8, 1},
    {"torch.CharStorage", Type::i8, 1},   {"torch.ShortStorage", Type::i16, 2},
    {"torch.IntStorage", Type::i32, 4},   {"torch.LongStorage", Type::i64, 8},
};

constexpr std::string_view rebuild_tensor = "torch._utils._rebuild_tensor_v2";
constexpr std::string_view rebuild_parameter = "torch._utils._rebuild_parameter";

std::size_t element_size(Type type) {
  return std::find_if(std::begin(storage_types), std::end(storage_types),
                      [&](const StorageType& storage) { return storage.type == type; })
      ->element_size;
}

/// IEEE 754 binary16.
float half_to_float(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const float magnitude = exponent == 31  ? (fraction ? NAN : INFINITY)
                          : exponent == 0 ? std::ldexp(float(fraction), -24)
                                          : std::ldexp(float(fraction + 1024), exponent - 25);
  return bits >> 15 ? -magnitude : magnitude;
}

template <class T>
T load(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

/// The element at `at` as a T. The caller must not request integers from floats.
template <class T>
T element(Type type, const std::byte* at) {
  switch (type) {
    case Type::f64:
      return static_cast<T>(load<double>(at));
    case Type::f32:
      return static_cast<T>(load<float>(at));
    case Type::f16:
      return static_cast<T>(half_to_float(load<std::uint16_t>(at)));
    case Type::bf16: {
      const std::uint32_t bits = std::uint32_t(load<std::uint16_t>(at)) << 16;
      float value;
      std::memcpy(&value, &bits, sizeof value);
      return static_cast<T>(value);
    }
    case Type::u8:
      return static_cast<T>(load<std::uint8_t>(at));
    case Type::i8:
      return static_cast<T>(load<std::int8_t>(at));
    case Type::i16:
      return static_cast<T>(load<std::int16_t>(at));
    case Type::i32:
      return static_cast<T>(load<std::int32_t>(at));
    case Type::i64:
      return static_cast<T>(load<std::int64_t>(at));
  }
  return T();
}

bool is_contiguous(const TorchTensor& tensor) {
  std::uint64_t expected = 1;
  for (std::size_t d = tensor.shape.size(); d-- > 0;) {
    if (tensor.shape[d] != 1 && tensor.strides[d] != expected) return false;
    expected *= tensor.shape[d];
  }
  return true;
}

Input expect_zip(Input input) {
  input.seek(0);
  std::array<std::byte, 2> head;
  if (input.read_some(head) == 2 && head[0] == std::byte(0x80) && head[1] == std::byte(2))
    input.fail_at(0, "saved in the format of torch before 1.6",
                  "load and save it with torch 1.6 or later");
  return input;
}

}  // namespace

std::uint64_t TorchTensor::elements() const {
  std::uint64_t count = 1;
  for (const std::uint64_t size : shape) count *= size;
  return count;
}

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  std::string text = "[";
  for (const std::uint64_t size : shape) {
    if (text.size() > 1) text += ", ";
    text += size == any_size ? "any" : std::to_string(size);
  }
  return text + "]";
}

TorchArchive::TorchArchive(Input input) : zip_(expect_zip(std::move(input))) {
  const ZipEntry* data = nullptr;
  constexpr std::string_view suffix = "/data.pkl";
  for (const ZipEntry& entry : zip_.entries()) {
    const std::string_view name = entry.name;
    if (name.size() < suffix.size() || name.substr(name.size() - suffix.size()) != suffix) continue;
    if (data) fail("two pickles: \"" + data->name + "\" and \"" + entry.name + "\"");
    data = &entry;
  }
  if (!data) fail("a zip archive without */data.pkl: not saved by torch");
  prefix_ = data->name.substr(0, data->name.size() - suffix.size() + 1);
  if (const ZipEntry* order = zip_.find(prefix_ + "byteorder")) {
    const auto text = zip_.read_all(*order, 16);
    if (std::string_view(reinterpret_cast<const char*>(text.data()), text.size()) != "little")
      fail("saved by a big-endian machine: not supported");
  }
  std::vector<std::string_view> globals{rebuild_tensor, rebuild_parameter};
  for (const StorageType& storage : storage_types) globals.push_back(storage.global);
  pickle_ =
      std::make_unique<Pickle>(zip_.name() + ": " + data->name,
                               zip_.read_all(*data, Pickle::max_bytes), globals, zip_.budget());
  const Value& root = pickle()[pickle().root()];
  if (root.kind != Kind::dict)
    fail(std::string("holds ") + kind_name(root.kind) + ", expected a dict of tensors");
}

const Value* TorchArchive::find(std::string_view key) const {
  return pickle().find(pickle()[pickle().root()], key);
}

const Value& TorchArchive::at(std::string_view key) const {
  const Value* value = find(key);
  if (!value) fail("has no \"" + std::string(key) + "\"");
  return *value;
}

TorchTensor TorchArchive::tensor(const Value& value, std::string name) const {
  const Pickle& p = pickle();
  const auto bad = [&](const std::string& why) { p.fail(value, "\"" + name + "\" " + why); };
  // A parameter wraps a tensor: (tensor, requires_grad, hooks). Torch writes only one such wrapper.
  const Value* built = &value;
  const auto callable = [&]() -> std::string_view {
    return built->kind == Kind::constructed ? std::string_view(p[built->items[0]].text) : "";
  };
  if (callable() == rebuild_parameter) {
    const Value& arguments = p[built->items[1]];
    if (arguments.items.empty()) bad("is a parameter without a tensor");
    built = &p[arguments.items[0]];
  }
  if (callable() != rebuild_tensor)
    bad(std::string("is ") + kind_name(built->kind) + ", expected a tensor");

  // (storage, offset, size, stride, requires_grad, hooks, ..)
  const Value& arguments = p[built->items[1]];
  if (arguments.items.size() < 4) bad("is a tensor with too few arguments");
  const Value& storage = p[arguments.items[0]];
  const Value& offset = p[arguments.items[1]];
  const Value& shape = p[arguments.items[2]];
  const Value& strides = p[arguments.items[3]];
  // A persistent id is ('storage', type, key, device, number of elements).
  const Value* id = storage.kind == Kind::persistent ? &p[storage.items[0]] : nullptr;
  if (!id || id->kind != Kind::tuple || id->items.size() != 5 ||
      p[id->items[0]].text != "storage" || p[id->items[2]].kind != Kind::text ||
      p[id->items[4]].kind != Kind::integer || p[id->items[4]].integer < 0)
    bad("has no valid reference to its storage");

  TorchTensor tensor;
  const std::string_view type = p[id->items[1]].text;
  const auto* known = std::find_if(std::begin(storage_types), std::end(storage_types),
                                   [&](const StorageType& s) { return s.global == type; });
  if (known == std::end(storage_types)) bad("is of an unsupported type");
  tensor.type = known->type;
  tensor.storage = zip_.find(prefix_ + "data/" + p[id->items[2]].text);
  if (!tensor.storage)
    bad("lies in \"" + prefix_ + "data/" + p[id->items[2]].text + "\", which is missing");
  const auto numbers = static_cast<std::uint64_t>(p[id->items[4]].integer);
  if (numbers > tensor.storage->size / element_size(tensor.type))
    bad("lies in a storage of " + std::to_string(numbers) + " numbers, but \"" +
        tensor.storage->name + "\" has only " + std::to_string(tensor.storage->size) + " bytes");

  const auto natural = [&](const Value& v) {
    if (v.kind != Kind::integer || v.integer < 0) bad("has an invalid shape, stride or offset");
    return static_cast<std::uint64_t>(v.integer);
  };
  if (shape.kind != Kind::tuple || strides.kind != Kind::tuple ||
      shape.items.size() != strides.items.size() || shape.items.size() > 8)
    bad("has no shape");
  tensor.offset = natural(offset);
  for (const Pickle::Ref item : shape.items) tensor.shape.push_back(natural(p[item]));
  for (const Pickle::Ref item : strides.items) tensor.strides.push_back(natural(p[item]));

  const auto outside = [&] {
    bad("of shape " + shape_text(tensor.shape) + " does not fit into its storage of " +
        std::to_string(numbers) + " numbers");
  };
  // Each product and sum is limited by `numbers`, so none overflows. This also rejects tensors that
  // repeat numbers (stride 0); no trainer saves them.
  std::uint64_t elements = 1;
  const bool empty = std::count(tensor.shape.begin(), tensor.shape.end(), 0u) > 0;
  std::uint64_t last = tensor.offset;
  for (std::size_t d = 0; d < tensor.shape.size() && !empty; ++d) {
    if (tensor.shape[d] > numbers / elements) outside();
    elements *= tensor.shape[d];
    if (tensor.shape[d] == 1) continue;
    if (last > numbers || tensor.strides[d] > (numbers - last) / (tensor.shape[d] - 1)) outside();
    last += tensor.strides[d] * (tensor.shape[d] - 1);
  }
  if (!empty && last >= numbers) outside();
  tensor.name = std::move(name);
  tensor.origin = &value;
  return tensor;
}

void TorchArchive::expect_shape(const TorchTensor& tensor,
                                const std::vector<std::uint64_t>& wanted) const {
  bool fits = tensor.shape.size() == wanted.size();
  for (std::size_t d = 0; fits && d < wanted.size(); ++d)
    fits = wanted[d] == any_size || tensor.shape[d] == wanted[d];
  if (!fits)
    pickle().fail(*tensor.origin, "\"" + tensor.name + "\" is of shape " +
                                      shape_text(tensor.shape) + ", expected " +
                                      shape_text(wanted));
}

template <class T>
std::vector<T> TorchArchive::read(const TorchTensor& tensor) {
  take_memory(tensor, tensor.elements(), sizeof(T));
  std::vector<T> values(static_cast<std::size_t>(tensor.elements()));
  if (values.empty()) return values;
  const std::size_t size = element_size(tensor.type);
  const bool contiguous = is_contiguous(tensor);
  if (contiguous && tensor.type == Type::f32 && std::is_same_v<T, float>) {
    zip_.read(*tensor.storage, tensor.offset * size, std::as_writable_bytes(std::span(values)));
    return values;
  }
  std::uint64_t extent = 1;
  for (std::size_t d = 0; d < tensor.shape.size(); ++d)
    extent += tensor.strides[d] * (tensor.shape[d] - 1);
  PassingMemory passing(zip_.budget());
  take_memory(tensor, extent, size);
  std::vector<std::byte> bytes(static_cast<std::size_t>(extent) * size);
  zip_.read(*tensor.storage, tensor.offset * size, bytes);
  // Iterates over the shape, the last dimension fastest.
  std::vector<std::uint64_t> index(tensor.shape.size(), 0);
  std::uint64_t at = 0;
  for (T& value : values) {
    value = element<T>(tensor.type, bytes.data() + at * size);
    for (std::size_t d = index.size(); d-- > 0;) {
      at += tensor.strides[d];
      if (++index[d] < tensor.shape[d]) break;
      at -= tensor.strides[d] * tensor.shape[d];
      index[d] = 0;
    }
  }
  return values;
}

std::vector<float> TorchArchive::read_floats(const TorchTensor& tensor) {
  return read<float>(tensor);
}

std::vector<std::int64_t> TorchArchive::read_integers(const TorchTensor& tensor) {
  if (tensor.type == Type::f16 || tensor.type == Type::bf16 || tensor.type == Type::f32 ||
      tensor.type == Type::f64)
    pickle().fail(*tensor.origin, "\"" + tensor.name + "\" holds floats, expected integers");
  return read<std::int64_t>(tensor);
}

void TorchArchive::take_memory(const TorchTensor& tensor, std::uint64_t elements,
                               std::size_t each) const {
  MemoryBudget budget = zip_.budget();
  if (!budget.take(elements, each))
    pickle().fail(*tensor.origin, budget.refusal("\"" + tensor.name + "\""), max_memory_hint);
}

std::int64_t TorchArchive::integer(std::string_view key) const {
  const Value& value = at(key);
  if (value.kind != Kind::integer && value.kind != Kind::boolean)
    pickle().fail(value, "\"" + std::string(key) + "\" is " + kind_name(value.kind) +
                             ", expected an integer");
  return value.integer;
}

double TorchArchive::number(std::string_view key) const {
  const Value& value = at(key);
  if (value.kind == Kind::integer) return double(value.integer);
  if (value.kind != Kind::real)
    pickle().fail(
        value, "\"" + std::string(key) + "\" is " + kind_name(value.kind) + ", expected a number");
  return value.real;
}

void TorchArchive::fail(const std::string& reason) const {
  throw InputError({zip_.name()}, reason);
}

}  // namespace tureen
