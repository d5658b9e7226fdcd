// The trained parameters of a DiffSoup-style soup (arXiv 2603.27151, section 3).
//
// Texels are logits for all levels min_level .. max_level, concatenated per face, coarsest first.
// At each texel of max_level, the texture of a face is the sigmoid of the sum over the interpolated
// levels. Within the face, these sigmoids are interpolated (scene/lattice.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/scene.hpp"

namespace tureen::trainer {

inline constexpr int channels = 8;       // f0 .. f6, alpha: the order of LatticeTexture
inline constexpr int blend_channel = 3;  // between base colour (f0, f1, f2) and network
inline constexpr int alpha_channel = 7;

/// The color MLP, 16-16-16-3. Its parameters are stored layer by layer: W1 [16][16], b1 [16],
/// W2 [16][16], b2 [16], W3 [3][16], b3 [3], row-major [out][in].
inline constexpr int mlp_inputs = 16, mlp_width = 16, mlp_outputs = 3;
inline constexpr int mlp_parameters = 16 * 16 + 16 + 16 * 16 + 16 + 3 * 16 + 3;  // 595
using MlpParameters = std::array<float, mlp_parameters>;

struct Model {
  int min_level = 0;
  int max_level = 0;
  std::vector<glm::vec3> positions;  // three per face, relative to origin
  std::vector<float> logits;         // [face][texel of all levels][channels]
  MlpParameters mlp{};
  glm::dvec3 origin{0.0};

  std::size_t faces() const { return positions.size() / 3; }
  /// Texels of one face, over all levels.
  std::size_t texels() const;
  /// The logits of one face: texels() x channels.
  std::span<const float> face_logits(std::size_t face) const;
  std::span<float> face_logits(std::size_t face);
};

/// The sum of all levels of one face: texel_count(max_level) x channels logits.
void fine_logits(const Model& model, std::size_t face, std::span<float> out);

enum class LiftedOpacity {
  kept,
  reset,  // logits 0, opacity 1/2 everywhere (published)
};

/// The model on levels min_level .. max_level; the coarse-to-fine step of training. At every texel
/// of max_level, the sum of the new levels equals the interpolation of the old ones. If min_level
/// is at least the old max_level, level min_level holds this function and all levels above are 0. A
/// max_level below the old one loses finer detail. Positions and MLP do not change.
Model lifted(const Model& from, int min_level, int max_level, LiftedOpacity opacity);

/// The fine texture of one face: texel_count(max_level) x channels values in [0, 1]. The backends
/// draw the same bits, so alpha is on the same side of alpha_threshold: at least 1/2 for logits of
/// at least 0, and below 1/2 for logits below -2e-7. In between, rounding decides: floats round
/// 1 + exp(-logit) to 2.
void fine_texture(const Model& model, std::size_t face, std::vector<float>& out);

/// The soup for `tureen render`: float texels at max_level with the color MLP. The caller adds the
/// cameras and completes info.
Scene to_scene(const Model& model);

struct FromScene {
  int min_level = 0;
  int max_level = 0;
  std::uint64_t seed = 0;  // for the MLP, if the scene has none with our shape
};

/// A model with the triangles of any scene, each with its own three vertices, for further training.
///
/// A lattice texture with a color MLP of our shape keeps its values at the texels of max_level.
/// They are clamped to 1e-4 .. 1 - 1e-4 (1e-4 is 1/40 of a byte's step), so gradients still reach
/// them. Any other appearance becomes base colour: per texel for lattices without an MLP, per
/// corner for vertex colours, and the mean of the face for all others. The MLP then begins at
/// random with a small weight. Opacity begins at 1/2, except for lattices, which keep theirs. The
/// origin moves to the middle of the soup if its distance exceeds the soup's diameter. Throws
/// InputError if the scene has no triangle.
Model from_scene(Scene scene, const FromScene& options);

}  // namespace tureen::trainer
