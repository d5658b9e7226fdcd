// What is drawn: triangles, each owning its appearance.
//
// Face t of `triangles` is also face t of the appearance: never reorder one without the other.
// All colours are display-referred sRGB in [0, 1]; nothing linearises or encodes them on the way.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <variant>
#include <vector>

#include "image/image.hpp"
#include "scene/color_mlp.hpp"

namespace tureen {

/// A fragment exists where its alpha, interpolated over the face, is at least this.
inline constexpr float alpha_threshold = 0.5f;

/// One colour a face. A face whose alpha is below alpha_threshold is not drawn.
struct FaceColors {
  std::vector<glm::vec4> rgba;  // one a face
};

/// One colour a vertex, interpolated perspective-correctly; cut out by interpolated alpha.
struct VertexColors {
  std::vector<glm::vec4> rgba;  // one a vertex
};

/// View-dependent colour max(0, 1/2 + sum_i Y_i(d) c_i), clamped to 1. For faces d is the
/// direction at the centroid, for vertices the direction at the vertex and the resulting colour
/// is interpolated perspective-correctly. Opaque. Triangle Splatting (arXiv 2505.19175).
struct Harmonics {
  enum class Domain { face, vertex };
  Domain domain = Domain::face;
  int degree = 0;  // 0..4
  ViewConvention view = ViewConvention::eye_to_surface;
  /// harmonics::count(degree) RGB coefficients an element, element by element.
  std::vector<glm::vec3> coefficients;
};

/// Where one face's lattice lies in LatticeTexture::texels.
struct LatticePatch {
  std::uint32_t first_texel = 0;
  std::uint32_t level = 0;  // 0..lattice::max_level
};

/// A lattice of features and alpha a face (scene/lattice.hpp; DiffSoup, arXiv 2603.27151). With a
/// color MLP the features are its inputs; without one, features 0..2 are the colour. Cut out where
/// the interpolated alpha is below alpha_threshold.
struct LatticeTexture {
  static constexpr int features = 7;
  static constexpr int channels = features + 1;  // f0 .. f6, alpha

  std::vector<LatticePatch> patches;  // one a face; faces may share texels
  /// `channels` values a texel, in [0, 1]: bytes stand for byte / 255.
  std::variant<std::vector<std::uint8_t>, std::vector<float>> texels;
  std::optional<ColorMlp> mlp;

  std::size_t texel_count() const;
  bool is_float() const { return std::holds_alternative<std::vector<float>>(texels); }
  /// One channel of one texel in [0, 1].
  float value(std::size_t texel, int channel) const;
};

/// How one material of UvTextures is sampled and cut out.
struct UvMaterial {
  enum class Wrap { repeat, mirror, clamp };
  enum class Filter { nearest, linear };

  /// Indices into UvTextures::images: none (factor alone), one (colour times factor), or, where
  /// there is a color MLP, two of equal size (eight features; factor is not used).
  std::vector<std::uint32_t> images;
  Wrap wrap_u = Wrap::repeat;
  Wrap wrap_v = Wrap::repeat;
  Filter filter = Filter::linear;
  glm::vec4 factor{1.0f};
  /// A fragment exists where this channel of the first image (times factor and vertex colour,
  /// where there is no MLP) is at least the threshold. 0 draws everything.
  int mask_channel = 3;
  float mask_threshold = 0.0f;
};

/// Conventional textures. (u, v) = (0, 0) is the top left corner of the first row. No mip levels:
/// what one sample sees is what the oracle sees. glTF 2.0 and MobileNeRF (arXiv 2208.00277).
struct UvTextures {
  std::vector<glm::vec2> uv;                    // one a vertex
  std::vector<std::uint32_t> material_of_face;  // one a face
  std::vector<UvMaterial> materials;
  std::vector<Image8> images;
  std::vector<glm::vec4> vertex_rgba;  // empty, or one a vertex: multiplies the colour
  std::optional<ColorMlp> mlp;         // of 8 features; never with vertex_rgba
};

using Appearance = std::variant<FaceColors, VertexColors, Harmonics, LatticeTexture, UvTextures>;

/// Names no face where a face is expected: a pixel that shows the background.
inline constexpr std::uint32_t no_face = 0xffffffffu;

struct TriangleSoup {
  std::vector<glm::vec3> positions;   // relative to Scene::origin
  std::vector<glm::uvec3> triangles;  // indices into positions
  Appearance appearance;
};

struct Bounds {
  glm::vec3 low{0.0f};
  glm::vec3 high{0.0f};
  glm::dvec3 centre() const { return 0.5 * (glm::dvec3(low) + glm::dvec3(high)); }
  /// Half the diagonal.
  double radius() const;
};

/// The box around all finite vertices that a triangle uses; zeros when there are none.
Bounds bounds(const TriangleSoup& soup);

/// Bytes that the vectors of this soup hold.
std::size_t byte_size(const TriangleSoup& soup);

/// The appearance in a word or two: "face colours", "lattice texture", ..
const char* appearance_name(const Appearance& appearance);

/// Why this soup cannot be drawn (an index out of range, a size that does not match, ..), or
/// nothing. Everything that consumes a soup relies on it; readers make sure of it. O(data).
std::optional<std::string> defect(const TriangleSoup& soup);

}  // namespace tureen
