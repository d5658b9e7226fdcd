// Accessors of a foreign glTF file as plain numbers: any component type, normalised or not, strided
// or tight, sparse or without bytes (zeros).
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "formats/gltf_document.hpp"

namespace tureen {

struct FloatAccessor {
  std::size_t count = 0;
  int components = 0;
  std::vector<float> values;  // count * components
};

/// Normalised integers become [0, 1] or [-1, 1] (glTF 2.0, section 3.6.2.2); others keep their
/// value. `components` lists how many an element may have.
FloatAccessor read_float_accessor(GltfDocument& document, int index,
                                  std::initializer_list<int> components);

/// Unsigned scalars, each below `limit`.
std::vector<std::uint32_t> read_index_accessor(GltfDocument& document, int index,
                                               std::size_t limit);

/// How many elements it has, 0 where there is no such accessor.
std::size_t accessor_count(const GltfDocument& document, int index);

}  // namespace tureen
