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
};

/// Whether the input begins like a GLB; its position is unchanged.
bool is_glb(Input& input);

/// Reads the structure from the start of the input and checks lengths, order and alignment of all
/// chunks. Chunks of unknown type are skipped. Throws InputError.
GlbContainer read_glb_container(Input& input);

/// The same from the first bytes of a partial file. Returns nullopt until the JSON chunk and the
/// header of the next chunk are complete. The chunk lengths are checked only against the file
/// length in the header. Throws InputError.
std::optional<GlbContainer> read_glb_beginning(Input& input);

}  // namespace tureen
