// Materials of a foreign glTF file, limited to the needs of a trained soup: base colour and
// cut-out.
#pragma once

#include <glm/mat3x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "formats/gltf/gltf_document.hpp"
#include "scene/remark.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

struct GltfMaterial {
  glm::dvec4 factor{1.0};      // linear, alpha last
  int image = -1;              // index into the file's images; -1: no texture
  int texture_coordinate = 0;  // n of TEXCOORD_n
  glm::dmat3x2 uv_transform{1.0};
  UvMaterial::Wrap wrap_u = UvMaterial::Wrap::repeat;
  UvMaterial::Wrap wrap_v = UvMaterial::Wrap::repeat;
  UvMaterial::Filter filter = UvMaterial::Filter::linear;
  bool masked = false;
  float cutoff = 0.0f;  // smallest alpha of an existing fragment, if masked
};

/// materials[index], or glTF's default material for -1. Appends to `remarks` each deviation of the
/// rendering from the file. Throws InputError.
GltfMaterial read_gltf_material(const GltfDocument& document, int index,
                                std::vector<Remark>& remarks);

}  // namespace tureen
