#include "formats/gltf_accessor.hpp"

#include <algorithm>
#include <cstring>

namespace tureen {

namespace {

struct Checked {
  const tinygltf::Accessor* accessor;
  std::string where;
  int components;
  std::size_t component_bytes;
};

std::size_t bytes_of_component(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

/// 1 to 4 for scalars and vectors, 0 for matrices.
int components_of(int type) {
  return type == TINYGLTF_TYPE_SCALAR ? 1
         : type == TINYGLTF_TYPE_VEC2 ? 2
         : type == TINYGLTF_TYPE_VEC3 ? 3
         : type == TINYGLTF_TYPE_VEC4 ? 4
                                      : 0;
}

Checked check(const GltfDocument& document, int index) {
  const auto& accessors = document.model().accessors;
  if (index < 0 || std::size_t(index) >= accessors.size())
    document.fail("accessors", "there is no accessor " + std::to_string(index) + " of " +
                                   std::to_string(accessors.size()));
  const tinygltf::Accessor& accessor = accessors[std::size_t(index)];
  Checked checked{&accessor, "accessors[" + std::to_string(index) + "]",
                  components_of(accessor.type), bytes_of_component(accessor.componentType)};
  if (checked.component_bytes == 0)
    document.fail(checked.where,
                  "component type " + std::to_string(accessor.componentType) + " is unknown");
  if (accessor.count == 0) document.fail(checked.where, "has no elements");
  if (accessor.bufferView < 0 && accessor.count > document.vertex_budget())
    document.fail(checked.where, std::to_string(accessor.count) +
                                     " elements without bytes of their own are too many");
  return checked;
}

template <class T>
T load(const std::byte* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

float load_float(const std::byte* bytes, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
      const float v = float(load<std::int8_t>(bytes));
      return normalized ? std::max(v / 127.0f, -1.0f) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
      const float v = float(load<std::uint8_t>(bytes));
      return normalized ? v / 255.0f : v;
    }
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
      const float v = float(load<std::int16_t>(bytes));
      return normalized ? std::max(v / 32767.0f, -1.0f) : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
      const float v = float(load<std::uint16_t>(bytes));
      return normalized ? v / 65535.0f : v;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: {
      const double v = double(load<std::uint32_t>(bytes));
      return float(normalized ? v / 4294967295.0 : v);
    }
    default:
      return load<float>(bytes);
  }
}

std::uint32_t load_unsigned(const std::byte* bytes, int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(bytes);
    default:
      return load<std::uint32_t>(bytes);
  }
}

bool is_index_type(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

/// Calls visit(element, bytes) for every element that has bytes, then for every one that the
/// sparse part replaces.
template <class Visit>
void for_each_element(GltfDocument& document, const Checked& checked, Visit&& visit) {
  const tinygltf::Accessor& accessor = *checked.accessor;
  const std::size_t each = checked.component_bytes * std::size_t(checked.components);
  if (accessor.bufferView >= 0) {
    const auto elements = document.elements(accessor.bufferView, accessor.byteOffset,
                                            accessor.count, each, checked.where);
    for (std::size_t i = 0; i < accessor.count; ++i) visit(i, elements.first + i * elements.stride);
  }
  if (!accessor.sparse.isSparse) return;

  const auto& sparse = accessor.sparse;
  const std::string where = checked.where + ".sparse";
  if (sparse.count < 1 || std::size_t(sparse.count) > accessor.count)
    document.fail(where, "its count of " + std::to_string(sparse.count) + " is outside 1.." +
                             std::to_string(accessor.count));
  if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
    document.fail(where, "has a negative byteOffset");
  if (!is_index_type(sparse.indices.componentType))
    document.fail(
        where, "its indices are of component type " + std::to_string(sparse.indices.componentType));
  const auto count = std::size_t(sparse.count);
  const auto indices =
      document.elements(sparse.indices.bufferView, std::uint64_t(sparse.indices.byteOffset), count,
                        bytes_of_component(sparse.indices.componentType), where + ".indices");
  const auto values =
      document.elements(sparse.values.bufferView, std::uint64_t(sparse.values.byteOffset), count,
                        each, where + ".values");
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t element =
        load_unsigned(indices.first + i * indices.stride, sparse.indices.componentType);
    if (element >= accessor.count)
      document.fail(where, "replaces element " + std::to_string(element) + " of " +
                               std::to_string(accessor.count));
    visit(std::size_t(element), values.first + i * values.stride);
  }
}

}  // namespace

std::size_t accessor_count(const GltfDocument& document, int index) {
  const auto& accessors = document.model().accessors;
  return index < 0 || std::size_t(index) >= accessors.size() ? 0
                                                             : accessors[std::size_t(index)].count;
}

FloatAccessor read_float_accessor(GltfDocument& document, int index,
                                  std::initializer_list<int> components) {
  const Checked checked = check(document, index);
  if (std::find(components.begin(), components.end(), checked.components) == components.end())
    document.fail(checked.where, "has elements of the wrong type for this use");
  FloatAccessor result{checked.accessor->count, checked.components, {}};
  const auto allocate = [&] {
    if (result.values.empty()) result.values.resize(result.count * std::size_t(result.components));
  };
  // Without bytes the count was held against the budget; with them, elements() holds it against
  // the buffer before the first visit.
  if (checked.accessor->bufferView < 0) allocate();
  for_each_element(document, checked, [&](std::size_t i, const std::byte* bytes) {
    allocate();
    for (int c = 0; c < result.components; ++c)
      result.values[i * std::size_t(result.components) + std::size_t(c)] =
          load_float(bytes + std::size_t(c) * checked.component_bytes,
                     checked.accessor->componentType, checked.accessor->normalized);
  });
  return result;
}

std::vector<std::uint32_t> read_index_accessor(GltfDocument& document, int index,
                                               std::size_t limit) {
  const Checked checked = check(document, index);
  if (checked.components != 1 || !is_index_type(checked.accessor->componentType))
    document.fail(checked.where, "indices must be unsigned scalars");
  std::vector<std::uint32_t> result;
  if (checked.accessor->bufferView < 0) result.resize(checked.accessor->count);
  for_each_element(document, checked, [&](std::size_t i, const std::byte* bytes) {
    if (result.empty()) result.resize(checked.accessor->count);
    result[i] = load_unsigned(bytes, checked.accessor->componentType);
  });
  for (std::size_t i = 0; i < result.size(); ++i)
    if (result[i] >= limit)
      document.fail(checked.where, "index " + std::to_string(i) + " names vertex " +
                                       std::to_string(result[i]) + " of " + std::to_string(limit));
  return result;
}

}  // namespace tureen
