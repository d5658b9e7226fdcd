#include "formats/scene_preview.hpp"

#include <algorithm>

#include "base/extension.hpp"
#include "formats/ply/ply_header.hpp"
#include "formats/splat/compressed_ply.hpp"
#include "formats/splat/splat_ply.hpp"
#include "formats/splat/splat_records.hpp"
#include "formats/tureen_glb/tureen_glb_preview.hpp"

namespace tureen {

namespace {

/// About 4 MB of a file of degree 3. Fewer splats rarely show what it is.
constexpr std::uint64_t first_splats = 16384;

/// Where the splats of a file are.
struct SplatRows {
  std::uint64_t body = 0, row_bytes = 0;
  std::optional<std::uint64_t> count;  // nullopt: up to the end of the file

  std::uint64_t rows_in(std::uint64_t bytes) const {
    const std::uint64_t rows = bytes > body ? (bytes - body) / row_bytes : 0;
    return count ? std::min(rows, *count) : rows;
  }
  PreviewSize next(std::uint64_t shown) const {
    const std::uint64_t rows = std::max(first_splats, 2 * rows_in(shown));
    if (count && rows >= *count) return {};
    return {body + rows * row_bytes, true};
  }
};

/// Returns nullopt if the vertices are not rows of one size, or not the first element.
std::optional<SplatRows> rows_of(const PlyHeader& header) {
  if (header.encoding == PlyHeader::Encoding::ascii || is_compressed_ply(header) ||
      !is_splat_ply(header) || header.elements.front().name != "vertex")
    return std::nullopt;
  const PlyElement& vertex = header.elements.front();
  if (std::any_of(vertex.properties.begin(), vertex.properties.end(),
                  [](const PlyProperty& property) { return property.count_type.has_value(); }))
    return std::nullopt;
  return SplatRows{header.body, vertex.min_bytes(false), vertex.count};
}

/// Records have no signature: other content decides first, as in read_scene().
bool is_records(std::span<const std::byte> prefix, const std::string& name) {
  return extension_of(name) == ".splat" && !is_ply(prefix);
}

/// There is no (further) preview for other formats, and for all splats.
std::optional<PreviewSize> first_splats_size(std::span<const std::byte> prefix,
                                             const std::string& name, std::uint64_t shown) {
  if (prefix.size() < 4) return std::nullopt;
  if (is_records(prefix, name)) return SplatRows{0, splat_record_size, {}}.next(shown);
  if (!is_ply(prefix)) return PreviewSize{};
  Input input = Input::memory(name, prefix);
  const std::optional<PlyHeader> header = read_ply_beginning(input);
  if (!header) return std::nullopt;
  const std::optional<SplatRows> rows = rows_of(*header);
  return rows ? rows->next(shown) : PreviewSize{};
}

/// The splats that `prefix` holds, as the reader of the format returns them. Returns nullopt if
/// there are none. Throws InputError.
std::optional<Scene> read_first_splats(std::span<const std::byte> prefix, const std::string& name) {
  if (is_records(prefix, name)) {
    const std::size_t whole = prefix.size() / splat_record_size * splat_record_size;
    if (whole == 0) return std::nullopt;
    Input input = Input::memory(name, prefix.first(whole));
    return read_splat_records(input);
  }
  if (!is_ply(prefix)) return std::nullopt;
  Input beginning = Input::memory(name, prefix);
  std::optional<PlyHeader> header = read_ply_beginning(beginning);
  const std::optional<SplatRows> rows = header ? rows_of(*header) : std::nullopt;
  if (!rows || rows->rows_in(prefix.size()) == 0) return std::nullopt;
  header->elements.resize(1);
  header->elements[0].count = rows->rows_in(prefix.size());
  const std::uint64_t end = rows->body + header->elements[0].count * rows->row_bytes;
  Input input = Input::memory(name, prefix.first(static_cast<std::size_t>(end)));
  return read_splat_ply(input, *header, {});
}

}  // namespace

std::optional<PreviewSize> preview_size(std::span<const std::byte> prefix, const std::string& name,
                                        std::uint64_t shown) {
  const std::optional<PreviewSize> ours = tureen_glb_preview_size(prefix, name);
  if (!ours) return std::nullopt;
  if (ours->bytes > 0) return shown == 0 ? *ours : PreviewSize{};
  return first_splats_size(prefix, name, shown);
}

std::optional<Scene> read_preview(std::span<const std::byte> prefix, const std::string& name) {
  if (auto ours = read_tureen_glb_preview(prefix, name)) return ours;
  return read_first_splats(prefix, name);
}

}  // namespace tureen
