// The frame of a .glb file: a header, a JSON chunk, and at most one binary chunk, which is left in
// the file for whoever reads it piece by piece. glTF 2.0, section 4 (binary glTF layout).
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/input.hpp"

namespace tureen {

// An assertion of nlohmann's is taken for an exception that a move could throw.
struct GlbContainer {  // NOLINT(bugprone-exception-escape)
  nlohmann::json json;
  std::uint64_t binary_offset = 0;  // of the first byte within the file
  std::uint64_t binary_size = 0;    // 0 where there is no binary chunk
};

/// Whether the input begins as a GLB does; its position is kept.
bool is_glb(Input& input);

/// Reads the frame from the start of the input and checks it whole: lengths, order and alignment of
/// the chunks. Chunks of unknown type are skipped. Throws InputError.
GlbContainer read_glb_container(Input& input);

/// The same from the first bytes of a file that is still arriving: nothing until the JSON chunk and
/// the header of the one behind it are there. What the header says of bytes to come is checked
/// against the length of the file that it says, and believed. Throws InputError.
std::optional<GlbContainer> read_glb_beginning(Input& input);

}  // namespace tureen
