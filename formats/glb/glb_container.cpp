#include "formats/glb/glb_container.hpp"

#include <algorithm>
#include <bit>
#include <string_view>

#include "base/json/json_view.hpp"

namespace tureen {

static_assert(std::endian::native == std::endian::little, "GLB values are read without conversion");

namespace {

constexpr std::uint32_t magic = 0x46546C67;       // "glTF"
constexpr std::uint32_t json_chunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t bin_chunk = 0x004E4942;   // "BIN\0"

constexpr std::uint64_t header_bytes = 12, chunk_header_bytes = 8;

constexpr char trailing_bytes[] = "bytes follow the end of the file: its header gives ";

std::string lengths(std::uint64_t length, const Input& input) {
  return std::to_string(length) + " bytes, it has " + std::to_string(input.size());
}

/// Reads the header at the start of the input. Returns the length of the file from it.
std::uint64_t read_header(Input& input) {
  input.seek(0);
  if (input.read_value<std::uint32_t>("the GLB header") != magic)
    input.fail_at(0, "not a GLB file: it does not begin with \"glTF\"");
  const auto version = input.read_value<std::uint32_t>("the GLB header");
  if (version != 2)
    input.fail_at(4, "GLB version " + std::to_string(version) + ", only 2 is supported");
  return input.read_value<std::uint32_t>("the GLB header");
}

struct Chunk {
  std::uint64_t header = 0;  // offset of the chunk header
  std::uint64_t start = 0;   // offset of the content
  std::uint32_t size = 0;
  std::uint32_t type = 0;
};

/// Reads a chunk header at the current position: number `index` in a file of `length` bytes.
Chunk read_chunk_header(Input& input, int index, std::uint64_t length) {
  Chunk chunk;
  chunk.header = input.position();
  chunk.size = input.read_value<std::uint32_t>("a GLB chunk header");
  chunk.type = input.read_value<std::uint32_t>("a GLB chunk header");
  chunk.start = input.position();
  const auto fail = [&](const std::string& reason) { input.fail_at(chunk.header, reason); };
  const std::string size = "a GLB chunk of " + std::to_string(chunk.size) + " bytes, ";
  if (chunk.size > length - chunk.start)
    fail(size + "but " + std::to_string(length - chunk.start) + " are left");
  if ((chunk.type == json_chunk) != (index == 0))
    fail(index == 0 ? "the first GLB chunk is not JSON" : "a second JSON chunk in the GLB file");
  return chunk;
}

/// The place of the chunk after one of odd length: at its end, or at the next multiple of 4 if only
/// there is a binary chunk, or the end of the file.
std::uint64_t after_odd_chunk(Input& input, const Chunk& chunk, std::uint64_t length) {
  const std::uint64_t end = chunk.start + chunk.size, aligned = (end + 3) / 4 * 4;
  if (aligned > length) return end;
  if (aligned == length) return aligned;
  std::uint32_t type = 0;
  input.seek(std::min(end + 4, length));
  input.read_some(std::as_writable_bytes(std::span(&type, 1)));
  return type == bin_chunk ? end : aligned;
}

/// Reads the JSON, or stores the location of the binary chunk.
void take(Input& input, const Chunk& chunk, int index, GlbContainer& glb) {
  if (chunk.type == json_chunk) {
    const auto text = input.read_values<char>(chunk.size, "the JSON chunk");
    glb.json = parse_json(std::string_view(text.data(), text.size()), input.name(), chunk.start,
                          input.budget());
  } else if (chunk.type == bin_chunk) {
    if (index != 1)
      input.fail_at(chunk.header, glb.binary_offset != 0 ? "a second binary chunk in the GLB file"
                                                         : "the binary chunk is not the second");
    glb.binary_offset = chunk.start;
    glb.binary_size = chunk.size;
  }
}

void require_json(const Input& input, const GlbContainer& glb) {
  if (glb.json.is_null()) input.fail("the GLB file has no JSON chunk");
}

}  // namespace

bool is_glb(Input& input) {
  const std::uint64_t start = input.position();
  std::uint32_t head = 0;
  const std::size_t got = input.read_some(std::as_writable_bytes(std::span(&head, 1)));
  input.seek(start);
  return got == sizeof head && head == magic;
}

GlbContainer read_glb_container(Input& input) {
  const std::uint64_t length = read_header(input);
  if (length != input.size())
    input.fail_at(
        8, (length > input.size() ? "the file is cut short: its header gives " : trailing_bytes) +
               lengths(length, input));
  GlbContainer glb;
  for (int index = 0; input.remaining() > 0; ++index) {
    const Chunk chunk = read_chunk_header(input, index, length);
    take(input, chunk, index, glb);
    const bool is_odd = chunk.size % 4 != 0;
    glb.is_aligned = glb.is_aligned && !is_odd;
    input.seek(is_odd ? after_odd_chunk(input, chunk, length) : chunk.start + chunk.size);
  }
  require_json(input, glb);
  return glb;
}

std::optional<GlbContainer> read_glb_beginning(Input& input) {
  if (input.size() < header_bytes) return std::nullopt;
  const std::uint64_t length = read_header(input);
  if (length < input.size()) input.fail_at(8, trailing_bytes + lengths(length, input));
  GlbContainer glb;
  // A binary chunk, if any, is the second one.
  for (int index = 0; index < 2 && input.position() < length; ++index) {
    const std::uint64_t to_come = length - input.size();
    if (input.remaining() < chunk_header_bytes && to_come > 0) return std::nullopt;
    const Chunk chunk = read_chunk_header(input, index, length);
    if (chunk.size % 4 != 0) input.fail_at(chunk.header, "a GLB chunk of odd length");
    if (chunk.type == json_chunk && chunk.size > input.remaining()) return std::nullopt;
    take(input, chunk, index, glb);
  }
  require_json(input, glb);
  return glb;
}

}  // namespace tureen
