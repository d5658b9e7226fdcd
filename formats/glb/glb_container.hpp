// The structure of a .glb file: a header, a JSON chunk, and at most one binary chunk. The binary
// chunk stays in the file and is read in parts. glTF 2.0, section 4 (binary glTF layout).
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/input.hpp"

namespace tureen {

// clang-tidy takes an assertion of nlohmann for an exception that a move could throw.
struct GlbContainer {  // NOLINT(bugprone-exception-escape)
  nlohmann::json json;
  std::uint64_t binary_offset = 0;  // first byte, within the file
  std::uint64_t binary_size = 0;    // 0 without a binary chunk
  bool is_aligned = true;           // whether the lengths of all chunks are multiples of 4
};

/// Whether the input begins like a GLB; its position is unchanged.
bool is_glb(Input& input);

/// Reads the structure from the start of the input and checks lengths and order of all chunks.
/// After a chunk of odd length, the next one begins at once or at a multiple of 4, as its writer
/// has it. Chunks of unknown type are skipped. Throws InputError.
GlbContainer read_glb_container(Input& input);

/// The same from the first bytes of a partial file, whose chunks are aligned. Returns nullopt until
/// the JSON chunk and the header of the next chunk are complete. The chunk lengths are checked only
/// against the file length in the header. Throws InputError.
std::optional<GlbContainer> read_glb_beginning(Input& input);

}  // namespace tureen
