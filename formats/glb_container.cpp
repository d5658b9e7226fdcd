#include "formats/glb_container.hpp"

#include <array>
#include <bit>
#include <optional>
#include <string_view>

#include "formats/json_view.hpp"

namespace tureen {

static_assert(std::endian::native == std::endian::little, "GLB is read as it lies in memory");

namespace {

constexpr std::uint32_t magic = 0x46546C67;       // "glTF"
constexpr std::uint32_t json_chunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t bin_chunk = 0x004E4942;   // "BIN\0"

}  // namespace

bool is_glb(Input& input) {
  const std::uint64_t start = input.position();
  std::uint32_t head = 0;
  const std::size_t got = input.read_some(std::as_writable_bytes(std::span(&head, 1)));
  input.seek(start);
  return got == sizeof head && head == magic;
}

GlbContainer read_glb_container(Input& input) {
  input.seek(0);
  if (input.read_value<std::uint32_t>("the GLB header") != magic)
    input.fail_at(0, "not a GLB file: it does not begin with \"glTF\"");
  const auto version = input.read_value<std::uint32_t>("the GLB header");
  if (version != 2) input.fail_at(4, "GLB version " + std::to_string(version) + ", only 2 is read");
  const auto length = input.read_value<std::uint32_t>("the GLB header");
  if (length != input.size())
    input.fail_at(8, (length > input.size() ? "the file is cut short: its header says "
                                            : "bytes trail the file: its header says ") +
                         std::to_string(length) + " bytes, it has " + std::to_string(input.size()));

  GlbContainer glb;
  for (int index = 0; input.remaining() > 0; ++index) {
    const std::uint64_t header = input.position();
    const auto size = input.read_value<std::uint32_t>("a GLB chunk header");
    const auto type = input.read_value<std::uint32_t>("a GLB chunk header");
    if (size > input.remaining())
      input.fail_at(header, "a GLB chunk of " + std::to_string(size) + " bytes, but " +
                                std::to_string(input.remaining()) + " are left");
    if (size % 4 != 0)
      input.fail_at(header,
                    "a GLB chunk of " + std::to_string(size) + " bytes, which is no multiple of 4");
    if ((type == json_chunk) != (index == 0))
      input.fail_at(header, index == 0 ? "the first GLB chunk is not JSON"
                                       : "a second JSON chunk in the GLB file");
    if (type == json_chunk) {
      const std::uint64_t start = input.position();
      const auto text = input.read_values<char>(size, "the JSON chunk");
      glb.json = parse_json(std::string_view(text.data(), text.size()), input.name(), start);
      continue;
    }
    if (type == bin_chunk) {
      if (index != 1)
        input.fail_at(header, glb.binary_offset != 0 ? "a second binary chunk in the GLB file"
                                                     : "the binary chunk is not the second");
      glb.binary_offset = input.position();
      glb.binary_size = size;
    }
    input.seek(input.position() + size);
  }
  if (glb.json.is_null()) input.fail("the GLB file has no JSON chunk");
  return glb;
}

}  // namespace tureen
