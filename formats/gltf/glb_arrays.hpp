// The arrays of a GLB of ours: tightly packed in the binary chunk, found by accessor or by buffer
// view, checked against the bytes that there are before anything is allocated, and read from where
// they lie. Include it in sources only.
//
// What it does not do: foreign files, which are strided, sparse and of other types
// (formats/gltf/gltf_accessor.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "base/json_view.hpp"
#include "formats/gltf/glb_container.hpp"
#include "formats/tureen_glb/tureen_glb_layout.hpp"

namespace tureen {

class GlbArrays {
 public:
  /// No index and no count of ours passes this: vertices are named by 32 bits.
  static constexpr std::uint64_t max_count = std::numeric_limits<std::uint32_t>::max();

  /// Both must outlive this. `progress`, where there is one, is called after each array with the
  /// fraction of the input that lies behind it.
  GlbArrays(Input& input, const GlbContainer& glb, std::function<void(double)> progress = {});

  const JsonView& root() const { return root_; }
  const std::string& file() const { return input_.name(); }

  /// Where elements or bytes lie in the file.
  struct Location {
    std::uint64_t offset = 0;
    std::uint64_t size = 0;  // in bytes
    std::uint64_t end() const { return offset + size; }
  };

  /// glTF's name of the type, how many components it has, and glTF's number of their type.
  struct Format {
    const char* type;
    std::size_t components;
    int component_type;
  };

  /// Of the accessor that `holder` names by `key`: exactly `elements` of exactly this format. Of no
  /// bytes where an array of none is not named; any other must be there.
  Location location(const JsonView& holder, const char* key, std::uint64_t elements,
                    const Format& format) const;
  /// Of bufferViews[reference].
  Location view_location(const JsonView& reference) const;

  /// accessors[reference] itself.
  JsonView accessor(const JsonView& reference) const;

  /// The array at location(..): as many T as there are bytes for.
  template <class T>
  std::vector<T> read(const JsonView& holder, const char* key, std::uint64_t elements,
                      const Format& format) {
    return read_at<T>(location(holder, key, elements, format), key);
  }

  /// The same of a location that is known. `what` names it in errors.
  template <class T>
  std::vector<T> read_at(const Location& location, const char* what) {
    if (location.size == 0) return {};
    input_.seek(location.offset);
    auto values = input_.read_values<T>(location.size / sizeof(T), what);
    tell_progress();
    return values;
  }

  void tell_progress() const;

  /// Counts what is about to be allocated (base/input.hpp).
  void take_memory(std::uint64_t elements, std::size_t each, const char* what) {
    input_.take_memory(elements, each, what);
  }

  static std::size_t index(const JsonView& view) {
    return static_cast<std::size_t>(view.natural(max_count));
  }

 private:
  Location in_binary_chunk(const JsonView& view) const;

  Input& input_;
  const GlbContainer& glb_;
  std::function<void(double)> progress_;
  JsonView root_;
};

/// The formats that the extension has.
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
