// What is trained: the parameters of a DiffSoup-style soup (arXiv 2603.27151, section 3).
//
// Texels are logits of all levels min_level .. max_level, concatenated a face, coarsest first. The
// texture of a face at max_level is the sum over levels of what each interpolates there, then a
// sigmoid; only then is it interpolated within the face (scene/lattice.hpp).
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

/// 16-16-16-3, all numbers of one layer after those of the one before: W1 [16][16], b1 [16],
/// W2 [16][16], b2 [16], W3 [3][16], b3 [3], row-major [out][in].
inline constexpr int mlp_inputs = 16, mlp_width = 16, mlp_outputs = 3;
inline constexpr int mlp_parameters = 16 * 16 + 16 + 16 * 16 + 16 + 3 * 16 + 3;  // 595
using MlpParameters = std::array<float, mlp_parameters>;

struct Model {
  int min_level = 0;
  int max_level = 0;
  std::vector<glm::vec3> positions;  // three a face, relative to origin
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
  reset,  // logits 0, opacity 1/2 everywhere: as published
};

/// The model on levels min_level .. max_level; the coarse-to-fine step of training. At every texel
/// of max_level the sum of the new levels is what the old ones interpolate there; where min_level
/// is at least the old max_level, that function is the new min_level and all levels above are 0.
/// Where max_level is below the old one, finer detail is lost. Positions and MLP stay.
Model lifted(const Model& from, int min_level, int max_level, LiftedOpacity opacity);

/// The fine texture of one face: texel_count(max_level) x channels values in [0, 1]. They are
/// what the backends draw, to the bit, so that alpha is on the same side of alpha_threshold: at
/// least 1/2 where its logit is at least 0, below where it is less than -2e-7; in between floats
/// round 1 + exp(-logit) to 2.
void fine_texture(const Model& model, std::size_t face, std::vector<float>& out);

/// The soup that `tureen render` draws: float texels at max_level with the color MLP. Cameras and
/// info are the caller's to fill.
Scene to_scene(const Model& model);

struct FromScene {
  int min_level = 0;
  int max_level = 0;
  std::uint64_t seed = 0;  // of the MLP, where the scene brings none that fits
};

/// The triangles of any scene, each with three vertices of its own, to be trained further.
///
/// A lattice texture whose color MLP is shaped like ours keeps all of it: what it shows at the
/// texels of max_level (values beyond 1e-4 .. 1 - 1e-4 are clamped there, a fortieth of a byte's
/// step, so that gradients still reach them). Any other appearance becomes base colour: of
/// lattices without such an MLP the colour is kept texel by texel, of vertex colours corner by
/// corner, of the rest the mean of the face; the MLP then begins at random and with little weight,
/// and opacity at 1/2 but for lattices. The origin moves to the middle of the soup where that is
/// further away than the soup is large. Throws InputError when there is no triangle.
Model from_scene(Scene scene, const FromScene& options);

}  // namespace tureen::trainer
