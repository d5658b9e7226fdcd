// Accessors of a foreign glTF file as plain numbers: any component type, normalised or not, strided
// or tight, sparse or without bytes (zeros).
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "formats/gltf/gltf_document.hpp"

namespace tureen {

/// The number of elements of accessors[index], after a check that its bytes exist. An accessor
/// without bytes must fit in the document's vertex_budget(). Throws InputError otherwise.
std::size_t accessor_count(GltfDocument& document, int index);

/// A selection of an accessor's elements.
struct FloatElements {
  int components = 0;
  std::vector<float> values;  // `components` for each requested element, in that order
};

/// The elements `wanted`: ascending, unique, each below accessor_count(). Normalised integers
/// become [0, 1] or [-1, 1] (glTF 2.0, section 3.6.2.2); others keep their value. `components`
/// lists the allowed numbers of components. Time is proportional to the requested elements and the
/// sparse part, not to the accessor: exporters let thousands of primitives share a large one.
FloatElements read_float_elements(GltfDocument& document, int index,
                                  std::initializer_list<int> components,
                                  const std::vector<std::uint32_t>& wanted);

/// Unsigned scalars, each below `limit`.
std::vector<std::uint32_t> read_index_accessor(GltfDocument& document, int index,
                                               std::size_t limit);

}  // namespace tureen
