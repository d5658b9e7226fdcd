// The arrays of our GLB files, tightly packed in the binary chunk. They are located by accessor or
// by buffer view, checked against the available bytes before any allocation, and read in place.
// Include it only in sources.
//
// Not supported: foreign files, whose arrays may be strided, sparse or of other types
// (formats/gltf/gltf_accessor.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "base/json/json_view.hpp"
#include "formats/glb/component_types.hpp"
#include "formats/glb/file_range.hpp"
#include "formats/glb/glb_container.hpp"

namespace tureen {

class GlbArrays {
 public:
  /// Largest index and count in our files: vertices have 32-bit indices.
  static constexpr std::uint64_t max_count = std::numeric_limits<std::uint32_t>::max();

  /// Both must outlive this object. `progress` may be empty; it is called after each array with the
  /// fraction of the input already passed.
  GlbArrays(Input& input, const GlbContainer& glb, std::function<void(double)> progress = {});

  const JsonView& root() const { return root_; }
  const std::string& file() const { return input_.name(); }

  /// Position of elements or bytes in the file.
  using Location = FileRange;

  /// glTF's name of the type, its number of components, and glTF's number of the component type.
  struct Format {
    const char* type;
    std::size_t components;
    int component_type;
  };

  /// Location of the accessor under `key` of `holder`: exactly `elements` of exactly this format.
  /// If `elements` is 0 the key may be missing and the location is empty; otherwise it is required.
  Location location(const JsonView& holder, const char* key, std::uint64_t elements,
                    const Format& format) const;
  /// Location of bufferViews[reference].
  Location view_location(const JsonView& reference) const;

  JsonView accessor(const JsonView& reference) const;

  /// The array at location(..), as many T as fit in its bytes.
  template <class T>
  std::vector<T> read(const JsonView& holder, const char* key, std::uint64_t elements,
                      const Format& format) {
    return read_at<T>(location(holder, key, elements, format), key);
  }

  /// The same for a known location. `what` is its name in errors.
  template <class T>
  std::vector<T> read_at(const Location& location, const char* what) {
    if (location.size == 0) return {};
    input_.seek(location.offset);
    auto values = input_.read_values<T>(location.size / sizeof(T), what);
    tell_progress();
    return values;
  }

  /// From now on, every array must begin at or after the end of all arrays located so far.
  /// Otherwise a small file could fill the memory with many layers from the same bytes.
  void begin_layer() { first_byte_ = end_; }

  void tell_progress() const;

  /// Counts memory before its allocation (base/input.hpp).
  void take_memory(std::uint64_t elements, std::size_t each, const char* what) {
    input_.take_memory(elements, each, what);
  }
  MemoryBudget budget() const { return input_.budget(); }

  static std::size_t index(const JsonView& view) {
    return static_cast<std::size_t>(view.natural(max_count));
  }

 private:
  Location in_binary_chunk(const JsonView& view) const;

  Input& input_;
  const GlbContainer& glb_;
  std::function<void(double)> progress_;
  JsonView root_;
  // Offsets in the binary chunk.
  std::uint64_t first_byte_ = 0;
  mutable std::uint64_t end_ = 0;  // mutable: a note of what was located, not part of the result
};

/// The formats in the extension.
namespace glb_formats {
inline constexpr GlbArrays::Format scalar_u8{"SCALAR", 1, glb_layout::unsigned_byte};
inline constexpr GlbArrays::Format scalar_u32{"SCALAR", 1, glb_layout::unsigned_int};
inline constexpr GlbArrays::Format scalar_float{"SCALAR", 1, glb_layout::float32};
inline constexpr GlbArrays::Format vec2_float{"VEC2", 2, glb_layout::float32};
inline constexpr GlbArrays::Format vec3_float{"VEC3", 3, glb_layout::float32};
inline constexpr GlbArrays::Format vec4_float{"VEC4", 4, glb_layout::float32};
inline constexpr GlbArrays::Format vec4_unorm8{"VEC4", 4, glb_layout::unsigned_byte};
inline constexpr GlbArrays::Format vec4_unorm16{"VEC4", 4, glb_layout::unsigned_short};
}  // namespace glb_formats

}  // namespace tureen
