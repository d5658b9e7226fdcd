#include "formats/gltf/gltf_meshopt.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

namespace tureen {

namespace {

using Stride = std::size_t;

/// The limits are also meshoptimizer's preconditions, which it only asserts.
struct Mode {
  const char* name;
  bool (*allows)(std::size_t count, Stride);
  int (*decode)(void*, std::size_t count, Stride, const unsigned char*, std::size_t);
};

bool is_index_size(Stride stride) { return stride == 2 || stride == 4; }

constexpr Mode modes[] = {
    {"ATTRIBUTES",
     [](std::size_t, Stride stride) { return stride > 0 && stride <= 256 && stride % 4 == 0; },
     meshopt_decodeVertexBuffer},
    {"TRIANGLES",
     [](std::size_t count, Stride stride) { return count % 3 == 0 && is_index_size(stride); },
     meshopt_decodeIndexBuffer},
    {"INDICES", [](std::size_t, Stride stride) { return is_index_size(stride); },
     meshopt_decodeIndexSequence}};

struct Filter {
  const char* name;
  bool (*allows)(Stride);
  void (*apply)(void*, std::size_t count, Stride);
};

constexpr Filter filters[] = {
    {"NONE", [](Stride) { return true; }, [](void*, std::size_t, Stride) {}},
    {"OCTAHEDRAL", [](Stride stride) { return stride == 4 || stride == 8; },
     meshopt_decodeFilterOct},
    {"QUATERNION", [](Stride stride) { return stride == 8; }, meshopt_decodeFilterQuat},
    {"EXPONENTIAL", [](Stride stride) { return stride % 4 == 0; }, meshopt_decodeFilterExp}};

/// The entry of a table with this name; fails at `json` without one.
template <class Entry, std::size_t Size>
const Entry& named(const JsonView& json, const std::string& name, const Entry (&table)[Size]) {
  const auto found =
      std::find_if(table, table + Size, [&](const Entry& entry) { return entry.name == name; });
  if (found == table + Size) json.fail("\"" + name + "\" is unknown");
  return *found;
}

}  // namespace

std::vector<std::byte> decode_meshopt(const JsonView& extension, std::span<const std::byte> stored,
                                      MemoryBudget budget) {
  const auto count =
      std::size_t(extension["count"].natural(std::numeric_limits<std::uint32_t>::max()));
  const auto stride = Stride(extension["byteStride"].natural(256));
  const Mode& mode = named(extension["mode"], extension["mode"].text(), modes);
  const auto filter_name = extension.find("filter");
  const Filter& filter =
      filter_name ? named(*filter_name, filter_name->text(), filters) : filters[0];
  if (!mode.allows(count, stride) || !filter.allows(stride) ||
      (mode.decode != meshopt_decodeVertexBuffer && &filter != filters))
    extension.fail(std::to_string(count) + " elements of " + std::to_string(stride) +
                   " bytes do not fit mode " + mode.name + " and filter " + filter.name);
  if (!budget.take(count, stride)) extension.fail(budget.refusal("the view"), max_memory_hint);
  std::vector<std::byte> bytes(count * stride);
  const auto* data = reinterpret_cast<const unsigned char*>(stored.data());
  if (count > 0 && mode.decode(bytes.data(), count, stride, data, stored.size()) != 0)
    extension.fail("its " + std::to_string(stored.size()) + " bytes are damaged");
  if (count > 0) filter.apply(bytes.data(), count, stride);
  return bytes;
}

}  // namespace tureen
