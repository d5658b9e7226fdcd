#include "formats/gltf/gltf_accessor.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <limits>

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

/// Normalised integers are from -1 or 0 to 1.
template <class Integer>
float load_integer(const std::byte* bytes, bool normalized) {
  const auto value = double(load<Integer>(bytes));
  return float(normalized ? std::max(value / std::numeric_limits<Integer>::max(), -1.0) : value);
}

float load_float(const std::byte* bytes, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return load_integer<std::int8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load_integer<std::uint8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return load_integer<std::int16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load_integer<std::uint16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load_integer<std::uint32_t>(bytes, normalized);
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

std::size_t bytes_of_element(const Checked& checked) {
  return checked.component_bytes * std::size_t(checked.components);
}

/// All elements; `first` is null if the accessor has no bytes.
GltfDocument::Elements dense_elements(GltfDocument& document, const Checked& checked) {
  const tinygltf::Accessor& accessor = *checked.accessor;
  if (accessor.bufferView < 0) return {};
  return document.elements(accessor.bufferView, accessor.byteOffset, accessor.count,
                           bytes_of_element(checked), checked.where);
}

/// Calls visit(element, bytes) for every element that the sparse part replaces.
template <class Visit>
void for_each_sparse(GltfDocument& document, const Checked& checked, Visit&& visit) {
  const tinygltf::Accessor& accessor = *checked.accessor;
  const std::size_t each = bytes_of_element(checked);
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
    visit(element, values.first + i * values.stride);
  }
}

}  // namespace

std::size_t accessor_count(GltfDocument& document, int index) {
  const Checked checked = check(document, index);
  dense_elements(document, checked);
  return checked.accessor->count;
}

FloatElements read_float_elements(GltfDocument& document, int index,
                                  std::initializer_list<int> components,
                                  const std::vector<std::uint32_t>& wanted) {
  const Checked checked = check(document, index);
  if (std::find(components.begin(), components.end(), checked.components) == components.end())
    document.fail(checked.where, "has elements of the wrong type for this use");
  const auto elements = dense_elements(document, checked);
  const auto per_element = std::size_t(checked.components);
  document.take_memory(wanted.size() * per_element, sizeof(float), checked.where);
  FloatElements result{checked.components, std::vector<float>(wanted.size() * per_element)};
  const auto store = [&](std::size_t place, const std::byte* bytes) {
    for (std::size_t c = 0; c < per_element; ++c)
      result.values[place * per_element + c] =
          load_float(bytes + c * checked.component_bytes, checked.accessor->componentType,
                     checked.accessor->normalized);
  };
  if (elements.first)
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      assert(wanted[i] < checked.accessor->count);
      store(i, elements.first + wanted[i] * elements.stride);
    }
  for_each_sparse(document, checked, [&](std::uint32_t element, const std::byte* bytes) {
    const auto found = std::lower_bound(wanted.begin(), wanted.end(), element);
    if (found != wanted.end() && *found == element)
      store(std::size_t(found - wanted.begin()), bytes);
  });
  return result;
}

std::vector<std::uint32_t> read_index_accessor(GltfDocument& document, int index,
                                               std::size_t limit) {
  const Checked checked = check(document, index);
  const int type = checked.accessor->componentType;
  if (checked.components != 1 || !is_index_type(type))
    document.fail(checked.where, "indices must be unsigned scalars");
  const auto elements = dense_elements(document, checked);
  document.take_memory(checked.accessor->count, sizeof(std::uint32_t), checked.where);
  std::vector<std::uint32_t> result(checked.accessor->count);
  if (elements.first)
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = load_unsigned(elements.first + i * elements.stride, type);
  for_each_sparse(document, checked, [&](std::uint32_t element, const std::byte* bytes) {
    result[element] = load_unsigned(bytes, type);
  });
  for (std::size_t i = 0; i < result.size(); ++i)
    if (result[i] >= limit)
      document.fail(checked.where, "index " + std::to_string(i) + " names vertex " +
                                       std::to_string(result[i]) + " of " + std::to_string(limit));
  return result;
}

}  // namespace tureen
