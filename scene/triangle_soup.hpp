// The renderable model: triangles, each with its own appearance.
//
// Face t of `triangles` is also face t of the appearance: never reorder one without the other. All
// colours are display-referred sRGB in [0, 1]; after reading, no step linearises or encodes them.
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

/// Smallest alpha, interpolated over the face, at which a fragment exists.
inline constexpr float alpha_threshold = 0.5f;

/// One colour a face. A face whose alpha is below alpha_threshold is not drawn.
struct FaceColors {
  std::vector<glm::vec4> rgba;  // one a face
};

/// One colour a vertex, interpolated perspective-correctly. Points with an interpolated alpha below
/// alpha_threshold are not drawn.
struct VertexColors {
  std::vector<glm::vec4> rgba;  // one a vertex
};

/// View-dependent colour max(0, 1/2 + sum_i Y_i(d) c_i), clamped to 1. For faces d is the direction
/// at the centroid. For vertices d is the direction at the vertex, and the colour is interpolated
/// perspective-correctly. Opaque. Triangle Splatting (arXiv 2505.19175).
struct Harmonics {
  enum class Domain { face, vertex };
  Domain domain = Domain::face;
  int degree = 0;  // 0..4
  ViewConvention view = ViewConvention::eye_to_surface;
  /// For each face or vertex, in order: harmonics::count(degree) RGB coefficients.
  std::vector<glm::vec3> coefficients;
};

/// The position of one face's lattice in LatticeTexture::texels.
struct LatticePatch {
  std::uint32_t first_texel = 0;
  std::uint32_t level = 0;  // 0..lattice::max_level
};

/// One lattice per face; each texel has features and an alpha (scene/lattice.hpp; DiffSoup, arXiv
/// 2603.27151). With a color MLP the features are its inputs; without one, features 0..2 are the
/// colour. Points with interpolated alpha below alpha_threshold are cut out.
struct LatticeTexture {
  static constexpr int features = 7;
  static constexpr int channels = features + 1;  // f0 .. f6, alpha

  std::vector<LatticePatch> patches;  // one a face; faces may share texels
  /// `channels` values a texel, in [0, 1]; a byte has the value byte / 255.
  std::variant<std::vector<std::uint8_t>, std::vector<float>> texels;
  std::optional<ColorMlp> mlp;

  std::size_t texel_count() const;
  bool is_float() const { return std::holds_alternative<std::vector<float>>(texels); }
  /// One channel of one texel in [0, 1].
  float value(std::size_t texel, int channel) const;
};

/// Sampling and cut-out of one material of UvTextures.
struct UvMaterial {
  enum class Wrap { repeat, mirror, clamp };
  enum class Filter { nearest, linear };

  /// Indices into UvTextures::images. Without an image the colour is factor; with one, the image
  /// times factor. With a color MLP, two images of equal size hold eight features, and factor is
  /// unused.
  std::vector<std::uint32_t> images;
  Wrap wrap_u = Wrap::repeat;
  Wrap wrap_v = Wrap::repeat;
  Filter filter = Filter::linear;
  glm::vec4 factor{1.0f};
  /// A fragment exists where this channel of the first image is at least the threshold. Without an
  /// MLP it is multiplied by the same channel of factor and of the vertex colour. A threshold of 0
  /// draws everything.
  int mask_channel = 3;
  float mask_threshold = 0.0f;
};

/// Conventional textures. (u, v) = (0, 0) is the top left corner of the first row. There are no mip
/// levels, so one sample per pixel equals the oracle's. glTF 2.0 and MobileNeRF (arXiv 2208.00277).
struct UvTextures {
  std::vector<glm::vec2> uv;                    // one a vertex
  std::vector<std::uint32_t> material_of_face;  // one a face
  std::vector<UvMaterial> materials;
  std::vector<Image8> images;
  std::vector<glm::vec4> vertex_rgba;  // empty, or one a vertex: multiplies the colour
  std::optional<ColorMlp> mlp;         // of 8 features; never with vertex_rgba
};

using Appearance = std::variant<FaceColors, VertexColors, Harmonics, LatticeTexture, UvTextures>;

/// The face index of a background pixel.
inline constexpr std::uint32_t no_face = 0xffffffffu;

struct TriangleSoup {
  std::vector<glm::vec3> positions;   // in layer coordinates (Layer::world_from_layer)
  std::vector<glm::uvec3> triangles;  // indices into positions
  Appearance appearance;
  /// Empty, or one a vertex: the normal that rays interpolate over a face, of unit length. A face
  /// with a corner of normal zero is flat: its own normal applies.
  std::vector<glm::vec3> normals = {};
};

/// Triangles that share no corners: t has the corners 3t, 3t + 1 and 3t + 2.
std::vector<glm::uvec3> unshared_triangles(std::size_t count);

struct Bounds {
  glm::vec3 low{0.0f};
  glm::vec3 high{0.0f};
  glm::dvec3 center() const { return 0.5 * (glm::dvec3(low) + glm::dvec3(high)); }
  /// Half the diagonal.
  double radius() const;
};

/// The box around all finite vertices of the triangles; zeros if there are none.
Bounds bounds(const TriangleSoup& soup);

/// Bytes in the vectors of this soup.
std::size_t byte_size(const TriangleSoup& soup);

/// The appearance in one or two words: "face colours", "lattice texture", ..
const char* appearance_name(const Appearance& appearance);

/// The reason why this soup cannot be drawn (an index out of range, a size that does not match,
/// ..), or nullopt. Readers return soups without a defect, and all users of a soup rely on that.
/// O(data).
std::optional<std::string> defect(const TriangleSoup& soup);

}  // namespace tureen
