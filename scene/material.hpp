// How the surface of a mesh layer reflects and transmits light, in glTF's terms: metallic and
// roughness, KHR_materials_transmission and KHR_materials_ior. Only rays (tracing/) use it; OpenGL
// draws every mesh by its appearance.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

namespace tureen {

/// The index of refraction of glTF's materials without another.
inline constexpr float default_ior = 1.5f;

struct Material {
  glm::vec3 base_color{1.0f};  // display-referred factor of reflected and transmitted light
  float metallic = 0.0f;       // 0..1
  float roughness = 1.0f;      // 0..1, the square root of GGX's alpha
  float transmission = 0.0f;   // 0..1, the part of the light that is not reflected and enters
  float ior = default_ior;     // index of refraction inside, at least 1

  bool operator==(const Material&) const = default;
};

/// Largest roughness of a surface that rays treat as perfectly smooth. GGX's alpha is then 0.01:
/// half of the reflected light lies within 1.2 degrees of the mirrored direction, since
/// tan(angle of the normal) = alpha there, and the reflection turns by twice that angle.
inline constexpr float max_smooth_roughness = 0.1f;

/// Metallic and smooth. glTF mixes metal and dielectric linearly, so from 1/2 on metal has the
/// larger part. No material is a mirror and glass: metal transmits nothing.
inline bool is_mirror(const Material& material) {
  return material.metallic >= 0.5f && material.roughness <= max_smooth_roughness;
}

/// Transmissive, not metallic, and smooth; 1/2 for the reason above.
inline bool is_glass(const Material& material) {
  return material.transmission >= 0.5f && material.metallic < 0.5f &&
         material.roughness <= max_smooth_roughness;
}

/// A perfect mirror; clear glass of this index.
inline Material mirror_material() { return {.metallic = 1.0f, .roughness = 0.0f}; }
inline Material glass_material(float ior) {
  return {.roughness = 0.0f, .transmission = 1.0f, .ior = ior};
}

/// The reason why a member is outside its range, or nullopt.
inline std::optional<std::string> defect(const Material& material) {
  const auto outside = [](float value) { return !(value >= 0.0f && value <= 1.0f); };
  const glm::vec3& color = material.base_color;
  if (outside(color.r) || outside(color.g) || outside(color.b))
    return "its base colour is outside 0..1";
  if (outside(material.metallic)) return "its metallic factor is outside 0..1";
  if (outside(material.roughness)) return "its roughness is outside 0..1";
  if (outside(material.transmission)) return "its transmission is outside 0..1";
  if (!(material.ior >= 1.0f && std::isfinite(material.ior)))
    return "its index of refraction is below 1 or not finite";
  return std::nullopt;
}

}  // namespace tureen
