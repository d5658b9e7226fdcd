// The texture of one face at a coarser lattice level: the piecewise-linear function on the coarse
// lattice that is nearest to the fine one in the mean square over the face (L2 projection).
//
// With the hat functions phi_i of the coarse texels and f the fine function, the coarse values c
// solve the normal equations sum_j <phi_i, phi_j> c_j = <phi_i, f>, whose matrix is the same for
// every face and is factorised once. What is left, f - sum c_j phi_j, is orthogonal to everything
// that the coarse lattice can show. Taking every second texel instead keeps what those texels say
// and loses the rest: more than 2 dB on textures of noise
// (tests/scene/lattice_projection_test.cpp).
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

  /// `fine` holds texel_count(from) texels of `channels` values each, `coarse` has room for
  /// texel_count(to). All of `fine` is finite, here and below. Functions that the coarse lattice
  /// can show (all affine ones) come back up to rounding. Values may leave the range of the fine
  /// ones: nothing is clamped.
  void project(int channels, std::span<const float> fine, std::span<float> coarse) const;

  struct Error {
    double largest = 0;  // anywhere on the face, in any channel
    double squared = 0;  // mean square over the face, summed over the channels
  };
  /// How far two functions on the face are apart, one on either lattice. Only the first
  /// `compared` of the `channels` count.
  Error error(int channels, int compared, std::span<const float> fine,
              std::span<const float> coarse) const;

  /// Alpha is not seen but for where it reaches 1/2 (alpha_threshold), so what is to be kept is the
  /// part of the face where it does. Of two functions, the projection of alpha and that of alpha
  /// clamped to 1/2 +- 1/8, each lifted by the constant that serves it best, this takes the one
  /// whose cut-out differs least, counted at the centroids of the fine lattice's 4^from triangles;
  /// a fine alpha that is opaque or transparent throughout becomes 1 or 0. Values are then drawn
  /// together around 1/2 until they lie in [0, 1], which moves no edge.
  ///
  /// Returns the fraction of the face where the cut-out differs, as counted.
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
