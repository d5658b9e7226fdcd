// The texture of one face at a coarser lattice level: the piecewise-linear function on the coarse
// lattice that minimises the mean squared error over the face (L2 projection).
//
// Let phi_i be the hat functions of the coarse texels and f the fine function. The coarse values c
// solve the normal equations sum_j <phi_i, phi_j> c_j = <phi_i, f>. Their matrix is the same for
// every face and is factorised once. The residual f - sum c_j phi_j is orthogonal to all functions
// on the coarse lattice. Taking every second texel instead costs more than 2 dB on textures of
// noise (tests/scene/lattice_projection_test.cpp).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tureen {

class LatticeProjection {
 public:
  /// 0 <= to <= from <= lattice::max_level.
  LatticeProjection(int from, int to);

  int from() const { return from_; }
  int to() const { return to_; }

  /// `fine` holds texel_count(from) texels of `channels` values each; `coarse` has room for
  /// texel_count(to). All of `fine` must be finite, here and below. Functions in the coarse space
  /// (all affine ones) are reproduced up to rounding. Values are not clamped and may leave the
  /// range of the fine ones.
  void project(int channels, std::span<const float> fine, std::span<float> coarse) const;

  struct Error {
    double largest = 0;  // anywhere on the face, in any channel
    double squared = 0;  // mean square over the face, summed over the channels
  };
  /// The difference of two functions on the face, one on each lattice. Only the first `compared` of
  /// the `channels` count.
  Error error(int channels, int compared, std::span<const float> fine,
              std::span<const float> coarse) const;

  /// Projects alpha, which is visible only through its threshold 1/2 (alpha_threshold): the covered
  /// part of the face is preserved. There are two candidates: the projection of alpha, and that of
  /// alpha clamped to 1/2 +- 1/8, each plus its best constant. The function takes the candidate
  /// with the smallest cut-out difference, counted at the centroids of the fine lattice's 4^from
  /// triangles. A fully opaque or transparent fine alpha becomes 1 or 0. Values are then scaled
  /// towards 1/2 until they lie in [0, 1], which moves no edge.
  ///
  /// Returns the fraction of the face with a different cut-out, as counted.
  double project_alpha(std::span<const float> fine, std::span<float> coarse) const;

  /// The same fraction for any two alphas.
  double coverage_mismatch(std::span<const float> fine, std::span<const float> coarse) const;

 private:
  struct Weighted {
    std::uint32_t texels[3];
    float weights[3];
  };

  void factorise();
  void solve(int channels, std::span<double> values) const;
  template <class Visit>
  void for_each_centroid(std::span<const float> fine, const Visit& visit) const;
  struct Cut;
  Cut best_cut(std::span<const float> fine, std::span<const float> coarse) const;

  int from_, to_;
  std::vector<Weighted> coarse_at_texel_;     // the coarse texels around each fine one
  std::vector<Weighted> coarse_at_centroid_;  // and around each fine triangle's centroid
  /// The Cholesky factor of the matrix above: row i holds columns i - band_ .. i.
  int band_ = 0;
  std::vector<double> factor_;
};

}  // namespace tureen
