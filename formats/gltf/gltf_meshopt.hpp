// Buffer views that EXT_meshopt_compression compresses, as gltfpack and gltf-transform write them.
//
// https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/EXT_meshopt_compression
// Decoded by meshoptimizer, whose decoders are made for untrusted bytes. Not supported: version 1
// of its format for attributes, which only KHR_meshopt_compression allows.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/json/json_view.hpp"
#include "base/memory_budget.hpp"

namespace tureen {

/// The bytes of a view: count * byteStride, whose memory is counted. `extension`: the view's object
/// EXT_meshopt_compression. `stored`: the bytes that it names. Throws InputError with the place in
/// the JSON.
std::vector<std::byte> decode_meshopt(const JsonView& extension, std::span<const std::byte> stored,
                                      MemoryBudget budget);

}  // namespace tureen
