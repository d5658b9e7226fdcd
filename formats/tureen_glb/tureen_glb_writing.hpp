// Code shared by the writers of TUREEN_triangle_soup: the binary chunk as a list of pieces, the
// JSON of the scene, and the file. Internal to tureen_glb_*.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/output.hpp"
#include "formats/tureen_glb/tureen_glb_layout.hpp"
#include "image/png.hpp"
#include "scene/scene.hpp"

namespace tureen::glb_writing {

using nlohmann::json;
namespace layout = glb_layout;

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

/// The binary chunk as a list of pieces, with the glTF arrays that describe it.
class BinaryPlan {
 public:
  /// The bytes must outlive the plan. Returns the buffer view's index.
  std::size_t view(std::span<const std::byte> bytes) {
    buffer_views.push_back({{"buffer", 0}, {"byteOffset", size_}, {"byteLength", bytes.size()}});
    pieces_.push_back(bytes);
    // Every piece begins at a multiple of 4, as glTF requires for accessors.
    size_ += (bytes.size() + 3) / 4 * 4;
    return buffer_views.size() - 1;
  }

  std::size_t owned_view(std::vector<std::byte> bytes) {
    owned_.push_back(std::move(bytes));
    return view(owned_.back());
  }

  struct Format {
    const char* type;
    int component;
    std::size_t components;
    bool normalized = false;
  };

  /// glTF allows no accessor without elements: an empty array adds no accessor and no key.
  void accessor(json& holder, const char* key, std::span<const std::byte> bytes,
                const Format& format) {
    if (bytes.empty()) return;
    const std::size_t component_bytes = format.component == layout::unsigned_byte    ? 1
                                        : format.component == layout::unsigned_short ? 2
                                                                                     : 4;
    json accessor = {{"bufferView", view(bytes)},
                     {"componentType", format.component},
                     {"count", bytes.size() / (component_bytes * format.components)},
                     {"type", format.type}};
    if (format.normalized) accessor["normalized"] = true;
    holder[key] = accessors.size();
    accessors.push_back(std::move(accessor));
  }

  template <class T>
  void owned_accessor(json& holder, const char* key, const std::vector<T>& values,
                      const Format& format) {
    const auto bytes = bytes_of(values);
    owned_.emplace_back(bytes.begin(), bytes.end());
    accessor(holder, key, owned_.back(), format);
  }

  std::size_t image(const Image8& image) {
    images.push_back({{"bufferView", owned_view(encode_png(image))}, {"mimeType", "image/png"}});
    return images.size() - 1;
  }

  std::uint64_t size() const { return size_; }

  void write(Output& output) const {
    static constexpr std::byte zeros[4]{};
    for (const auto& piece : pieces_) {
      output.write(piece);
      output.write(std::span(zeros).first((4 - piece.size() % 4) % 4));
    }
  }

  json buffer_views = json::array();
  json accessors = json::array();
  json images = json::array();

 private:
  std::uint64_t size_ = 0;
  std::vector<std::span<const std::byte>> pieces_;
  std::deque<std::vector<std::byte>> owned_;  // a deque: its elements never move
};

/// glTF's list of materials. The first is the unlit one of layers without a material.
class MaterialList {
 public:
  /// Returns the index of the material. Throws UsageError if it has a defect().
  std::size_t add(const Material& material);
  /// Sets the document's materials, unless nothing uses them, and extends its extensionsUsed.
  void write(json& document) const;

 private:
  std::vector<Material> materials_;
};

inline constexpr BinaryPlan::Format scalar_u32{"SCALAR", layout::unsigned_int, 1};
inline constexpr BinaryPlan::Format scalar_u8{"SCALAR", layout::unsigned_byte, 1};
inline constexpr BinaryPlan::Format scalar_float{"SCALAR", layout::float32, 1};
inline constexpr BinaryPlan::Format vec2_float{"VEC2", layout::float32, 2};
inline constexpr BinaryPlan::Format vec3_float{"VEC3", layout::float32, 3};
inline constexpr BinaryPlan::Format vec4_float{"VEC4", layout::float32, 4};
inline constexpr BinaryPlan::Format vec4_unorm8{"VEC4", layout::unsigned_byte, 4, true};
inline constexpr BinaryPlan::Format vec4_unorm16{"VEC4", layout::unsigned_short, 4, true};

/// Throws UsageError if the layer, its contents, its material or the quality has a defect().
template <class T>
void require_sound(const T& part) {
  if (const auto reason = defect(part)) throw UsageError("the scene cannot be written: " + *reason);
}

/// The JSON of everything except the version and the layers. Appends one sentence to `losses` for
/// each text that JSON cannot store. Throws UsageError as write_tureen_glb does.
json info_json(const Scene& scene, std::vector<std::string>& losses);

/// The layer's place in versions 1 and 3. Throws UsageError if a number is not finite.
void add_origin(json& extension, const Layer& layer);

/// Sets glTF's min and max of an accessor of positions, from their finite coordinates.
void add_range(json& accessor, const std::vector<glm::vec3>& positions);

/// A display-referred colour in 0..1 as linear 16-bit values, for COLOR_0.
glm::u16vec4 linear_unorm16(const glm::vec3& display, double alpha = 1.0);

/// The JSON of a color MLP; its weights are added to the plan.
json mlp_json(BinaryPlan& plan, const ColorMlp& mlp);

/// Adds the plan's arrays to the document and writes the file. Throws UsageError above 4 GiB,
/// OutputError if the file cannot be written.
void write_glb(json document, const BinaryPlan& plan, const std::filesystem::path& path);

}  // namespace tureen::glb_writing
