// Accessors of a foreign glTF file as plain numbers: any component type, normalised or not, strided
// or tight, sparse or without bytes (zeros).
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "formats/gltf/gltf_document.hpp"

namespace tureen {

/// How many elements accessors[index] has, once it is certain that its bytes are there (or, for one
/// without bytes, that the document's vertex_budget() allows it). Throws InputError otherwise.
std::size_t accessor_count(GltfDocument& document, int index);

/// Some elements of an accessor.
struct FloatElements {
  int components = 0;
  std::vector<float> values;  // `components` for each element asked for, in that order
};

/// The elements `wanted`, ascending and without repetition, each below accessor_count(). Normalised
/// integers become [0, 1] or [-1, 1] (glTF 2.0, section 3.6.2.2); others keep their value.
/// `components` lists how many an element may have. Takes the time of what is wanted, and of the
/// sparse part, not of the accessor: exporters let thousands of primitives draw on one large one.
FloatElements read_float_elements(GltfDocument& document, int index,
                                  std::initializer_list<int> components,
                                  const std::vector<std::uint32_t>& wanted);

/// Unsigned scalars, each below `limit`.
std::vector<std::uint32_t> read_index_accessor(GltfDocument& document, int index,
                                               std::size_t limit);

}  // namespace tureen
