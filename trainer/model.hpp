// What is trained: the parameters of a DiffSoup-style soup (arXiv 2603.27151, section 3).
//
// Texels are logits of all levels min_level .. max_level, concatenated a face, coarsest first. The
// texture of a face at max_level is the sum over levels of what each interpolates there, then a
// sigmoid; only then is it interpolated within the face (specs of soup/lattice.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "soup/scene.hpp"

namespace tureen::trainer {

inline constexpr int channels = 8;  // f0 .. f6, alpha: the order of LatticeTexture
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
};

/// Logits that interpolate, as `from`'s single or several levels do, but on levels
/// min_level .. max_level: the field of `from` at min_level, zero above. Levels of `from` above
/// min_level are lost. The coarse-to-fine step of training.
Model lifted(const Model& from, int min_level, int max_level, bool keep_opacity);

/// The fine texture of one face: texel_count(max_level) x channels values in [0, 1].
void fine_texture(const Model& model, std::size_t face, std::vector<float>& out);

/// The soup that `tureen render` draws: float texels at max_level with the color MLP.
Scene to_scene(const Model& model);

}  // namespace tureen::trainer
