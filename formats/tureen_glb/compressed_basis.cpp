#include "formats/tureen_glb/compressed_basis.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "scene/lattice.hpp"

namespace tureen {

namespace {

constexpr int features = LatticeTexture::features;
constexpr double one = 65536.0;  // 1.0 in fixed point

std::size_t at(int i) { return std::size_t(i); }

FeatureMatrix identity_matrix() {
  FeatureMatrix result{};
  for (int i = 0; i < features; ++i) result[at(i)][at(i)] = 1;
  return result;
}

FeatureMatrix product(const FeatureMatrix& a, const FeatureMatrix& b) {
  FeatureMatrix result{};
  for (int i = 0; i < features; ++i)
    for (int k = 0; k < features; ++k)
      for (int j = 0; j < features; ++j) result[at(i)][at(j)] += a[at(i)][at(k)] * b[at(k)][at(j)];
  return result;
}

struct Eigen {
  std::array<double, features> values;
  FeatureMatrix vectors;  // column j belongs to values[j]
};

/// Eigenvalues and eigenvectors of a symmetric matrix, by Jacobi's rotations.
Eigen eigen(FeatureMatrix a) {
  Eigen result{{}, identity_matrix()};
  // Convergence is quadratic: 7 x 7 is diagonal to the last bit after about 8 sweeps.
  for (int sweep = 0; sweep < 32; ++sweep)
    for (std::size_t p = 0; p < features; ++p)
      for (std::size_t q = p + 1; q < features; ++q) {
        if (a[p][q] == 0.0) continue;
        const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        if (!std::isfinite(t)) continue;
        const double c = 1 / std::sqrt(t * t + 1), s = c * t;
        const auto turn = [&](double& x, double& y) {
          const double old = x;
          x = c * old - s * y;
          y = s * old + c * y;
        };
        for (std::size_t k = 0; k < features; ++k) turn(a[k][p], a[k][q]);
        for (std::size_t k = 0; k < features; ++k) turn(a[p][k], a[q][k]);
        for (std::size_t k = 0; k < features; ++k) turn(result.vectors[k][p], result.vectors[k][q]);
      }
  for (std::size_t i = 0; i < features; ++i) result.values[i] = a[i][i];
  return result;
}

/// The covariance of the prediction residuals on the finest level of each patch, in squared bytes,
/// weighted by texel. A residual is a texel minus the mean of its two neighbours. The identity if
/// there are no residuals.
FeatureMatrix residual_covariance(const LatticeTexture& texture, std::span<const float> weights) {
  FeatureMatrix sum{};
  double total = 0;
  for (const LatticePatch& patch : texture.patches) {
    const int n = lattice::resolution(int(patch.level));
    const auto value = [&](int x, int y, int c) {
      return 255.0 * double(texture.value(patch.first_texel + lattice::texel_index(x, y), c));
    };
    for (int x = 0; x <= n; ++x)
      for (int y = 0; x + y <= n; ++y) {
        if (x % 2 == 0 && y % 2 == 0) continue;
        const int dx = x % 2, dy = x % 2 == 0 ? 1 : y % 2 == 0 ? 0 : -1;
        if (n == 1) continue;  // level 0 has only corners, and no prediction
        const std::uint32_t texel = patch.first_texel + lattice::texel_index(x, y);
        const double weight = weights.empty() ? 1 : double(weights[texel]);
        std::array<double, features> left;
        for (int c = 0; c < features; ++c)
          left[at(c)] = value(x, y, c) - (value(x - dx, y - dy, c) + value(x + dx, y + dy, c)) / 2;
        for (int i = 0; i < features; ++i)
          for (int j = 0; j < features; ++j)
            sum[at(i)][at(j)] += weight * left[at(i)] * left[at(j)];
        total += weight;
      }
  }
  if (total == 0) return identity_matrix();
  for (auto& row : sum)
    for (double& value : row) value /= total;
  return sum;
}

/// Gauss-Jordan elimination with pivots. The matrix of a basis is invertible.
FeatureMatrix inverse(FeatureMatrix a) {
  FeatureMatrix result = identity_matrix();
  for (std::size_t i = 0; i < features; ++i) {
    std::size_t pivot = i;
    for (std::size_t k = i; k < features; ++k)
      if (std::abs(a[k][i]) > std::abs(a[pivot][i])) pivot = k;
    std::swap(a[i], a[pivot]);
    std::swap(result[i], result[pivot]);
    assert(a[i][i] != 0.0);
    const double divisor = a[i][i];
    for (std::size_t j = 0; j < features; ++j) {
      a[i][j] /= divisor;
      result[i][j] /= divisor;
    }
    for (std::size_t k = 0; k < features; ++k) {
      if (k == i) continue;
      const double factor = a[k][i];
      for (std::size_t j = 0; j < features; ++j) {
        a[k][j] -= factor * a[i][j];
        result[k][j] -= factor * result[i][j];
      }
    }
  }
  return result;
}

}  // namespace

CompressedBasis CompressedBasis::identity() {
  CompressedBasis basis;
  for (std::size_t i = 0; i < features; ++i) basis.rows[i][i] = int(one);
  return basis;
}

std::uint8_t CompressedBasis::feature(int f, std::span<const std::int16_t> values) const {
  std::int64_t sum = 1 << 15;  // rounds to the nearest
  for (std::size_t j = 0; j < features; ++j) sum += std::int64_t(rows[at(f)][j]) * values[j];
  return static_cast<std::uint8_t>(std::clamp<std::int64_t>(sum >> 16, 0, 255));
}

std::vector<std::int16_t> CompressedBasis::values_of(std::span<const std::uint8_t> texels) const {
  FeatureMatrix forward;
  for (std::size_t i = 0; i < features; ++i)
    for (std::size_t j = 0; j < features; ++j) forward[i][j] = double(rows[i][j]) / one;
  forward = inverse(forward);
  std::vector<std::int16_t> result(texels.size());
  for (std::size_t t = 0; t < texels.size(); t += LatticeTexture::channels) {
    for (std::size_t i = 0; i < features; ++i) {
      double value = 0;
      for (std::size_t j = 0; j < features; ++j) value += forward[i][j] * double(texels[t + j]);
      result[t + i] = static_cast<std::int16_t>(std::lround(std::clamp(value, -32768.0, 32767.0)));
    }
    result[t + features] = texels[t + features];
  }
  return result;
}

CompressedBasis compressed_basis(const LatticeTexture& texture, const FeatureMatrix& sensitivity,
                                 double step, std::span<const float> weights) {
  assert(step > 0);
  assert(weights.empty() || weights.size() == texture.texel_count());
  Eigen metric = eigen(sensitivity);
  const double most = *std::max_element(metric.values.begin(), metric.values.end());
  // If no feature changes the colour, any step will do. The minimum of 1e-4 keeps the steps finite:
  // below it, one byte of a feature moves the colour by less than a hundredth of a byte.
  const double least = most > 0 ? std::max(most / 100, 1e-4) : 1;
  FeatureMatrix root{}, inverse_root{};
  for (std::size_t k = 0; k < features; ++k) {
    const double gain = std::sqrt(std::max(metric.values[k], least));
    for (std::size_t i = 0; i < features; ++i)
      for (std::size_t j = 0; j < features; ++j) {
        const double both = metric.vectors[i][k] * metric.vectors[j][k];
        root[i][j] += both * gain;
        inverse_root[i][j] += both / gain;
      }
  }
  const Eigen residual = eigen(product(product(root, residual_covariance(texture, weights)), root));
  const FeatureMatrix columns = product(inverse_root, residual.vectors);
  // Large residuals first: their sizes select the probability models of the others.
  std::array<std::size_t, features> order;
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return residual.values[a] > residual.values[b];
  });
  CompressedBasis basis;
  for (std::size_t i = 0; i < features; ++i)
    for (std::size_t j = 0; j < features; ++j)
      basis.rows[i][j] = static_cast<std::int32_t>(
          std::lround(columns[i][order[j]] * step / compress_fraction * one));
  return basis;
}

}  // namespace tureen
