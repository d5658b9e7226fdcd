#include "scene/edit/lattice_projection.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "scene/lattice.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

namespace {

using lattice::for_each_triangle;

/// The integral of u v, both linear on a triangle, is area / 12 (sum_k u_k v_k + sum_k u_k sum_k
/// v_k) with corners k. All triangles of a lattice have equal area, so area / 12 is omitted. The
/// unit is one fine triangle.
constexpr double own = 2, other = 1;

}  // namespace

LatticeProjection::LatticeProjection(int from, int to) : from_(from), to_(to) {
  assert(0 <= to && to <= from && from <= lattice::max_level);
  const double step = 1.0 / lattice::resolution(from);
  const auto around = [&](double b0, double b1) {
    const auto at = lattice::footprint(to, b0, b1);
    Weighted result;
    for (int k = 0; k < 3; ++k) {
      result.texels[k] = at.texels[k];
      result.weights[k] = float(at.weights[k]);  // exact at texels: multiples of 2^-7
    }
    return result;
  };
  for (std::uint32_t i = 0; i < lattice::texel_count(from); ++i) {
    const auto [x, y] = lattice::texel_coordinates(i);
    coarse_at_texel_.push_back(around(x * step, y * step));
  }
  for_each_triangle(from, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    int x = 0, y = 0;
    for (const std::uint32_t corner : {a, b, c}) {
      const auto at = lattice::texel_coordinates(corner);
      x += at.x;
      y += at.y;
    }
    coarse_at_centroid_.push_back(around(x * step / 3, y * step / 3));
  });
  factorise();
}

void LatticeProjection::factorise() {
  const int size = int(lattice::texel_count(to_));
  for_each_triangle(to_, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto [low, high] = std::minmax({int(a), int(b), int(c)});
    band_ = std::max(band_, high - low);
  });
  const int row = band_ + 1;
  factor_.assign(std::size_t(size) * row, 0.0);
  const auto at = [&](int i, int j) -> double& {
    return factor_[std::size_t(i) * row + (j - i + band_)];
  };
  const double area = double(1u << (2 * (from_ - to_)));  // of a coarse triangle, in fine triangles
  for_each_triangle(to_, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t i : {a, b, c})
      for (const std::uint32_t j : {a, b, c})
        if (j <= i) at(int(i), int(j)) += area * (i == j ? own : other);
  });
  // Cholesky decomposition within the band, without pivots: the matrix is positive definite and its
  // condition number is below 20 at every level.
  for (int i = 0; i < size; ++i)
    for (int j = std::max(0, i - band_); j <= i; ++j) {
      double sum = at(i, j);
      for (int k = std::max(0, i - band_); k < j; ++k) {
        if (k < j - band_) continue;
        sum -= at(i, k) * at(j, k);
      }
      at(i, j) = i == j ? std::sqrt(sum) : sum / at(j, j);
    }
}

void LatticeProjection::solve(int channels, std::span<double> values) const {
  const int size = int(lattice::texel_count(to_)), row = band_ + 1;
  const auto at = [&](int i, int j) { return factor_[std::size_t(i) * row + (j - i + band_)]; };
  const auto subtract = [&](int i, int j, double factor) {
    for (int c = 0; c < channels; ++c)
      values[i * channels + c] -= factor * values[j * channels + c];
  };
  const auto divide = [&](int i) {
    const double inverse = 1.0 / at(i, i);
    for (int c = 0; c < channels; ++c) values[i * channels + c] *= inverse;
  };
  for (int i = 0; i < size; ++i) {
    for (int j = std::max(0, i - band_); j < i; ++j) subtract(i, j, at(i, j));
    divide(i);
  }
  for (int i = size - 1; i >= 0; --i) {
    for (int j = std::min(size - 1, i + band_); j > i; --j) subtract(i, j, at(j, i));
    divide(i);
  }
}

void LatticeProjection::project(int channels, std::span<const float> fine,
                                std::span<float> coarse) const {
  assert(fine.size() == std::size_t(lattice::texel_count(from_)) * channels);
  assert(coarse.size() == std::size_t(lattice::texel_count(to_)) * channels);
  if (from_ == to_) {
    std::copy(fine.begin(), fine.end(), coarse.begin());
    return;
  }
  // <psi_j, f> for the hat functions psi_j of the fine texels.
  std::vector<double> moments(fine.size(), 0.0);
  for_each_triangle(from_, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (int k = 0; k < channels; ++k) {
      const double fa = fine[a * channels + k], fb = fine[b * channels + k],
                   fc = fine[c * channels + k];
      const double sum = other * (fa + fb + fc);
      moments[a * channels + k] += sum + (own - other) * fa;
      moments[b * channels + k] += sum + (own - other) * fb;
      moments[c * channels + k] += sum + (own - other) * fc;
    }
  });
  // <phi_i, f> for the coarse texels, since phi_i = sum_j phi_i(texel j) psi_j.
  std::vector<double> values(coarse.size(), 0.0);
  for (std::size_t j = 0; j < coarse_at_texel_.size(); ++j)
    for (int k = 0; k < 3; ++k) {
      const double weight = coarse_at_texel_[j].weights[k];
      if (weight == 0) continue;
      const std::size_t i = coarse_at_texel_[j].texels[k];
      for (int c = 0; c < channels; ++c)
        values[i * channels + c] += weight * moments[j * channels + c];
    }
  solve(channels, values);
  for (std::size_t i = 0; i < values.size(); ++i) coarse[i] = float(values[i]);
}

LatticeProjection::Error LatticeProjection::error(int channels, int compared,
                                                  std::span<const float> fine,
                                                  std::span<const float> coarse) const {
  // Both functions are linear on every fine triangle. The largest difference is therefore at a fine
  // texel, and the texels also determine the mean square.
  Error result;
  std::vector<double> difference(coarse_at_texel_.size());
  for (int c = 0; c < compared; ++c) {
    for (std::size_t j = 0; j < difference.size(); ++j) {
      const Weighted& at = coarse_at_texel_[j];
      double value = -double(fine[j * channels + c]);
      for (int k = 0; k < 3; ++k)
        value += double(at.weights[k]) * double(coarse[at.texels[k] * channels + c]);
      difference[j] = value;
      result.largest = std::max(result.largest, std::abs(value));
    }
    double sum = 0;
    for_each_triangle(from_, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
      const double a = difference[i], b = difference[j], d = difference[k];
      sum += (own - other) * (a * a + b * b + d * d) + other * (a + b + d) * (a + b + d);
    });
    result.squared += sum / (12.0 * double(1u << (2 * from_)));
  }
  return result;
}

/// visit(fine alpha, coarse footprint) at the centroid of each fine triangle.
template <class Visit>
void LatticeProjection::for_each_centroid(std::span<const float> fine, const Visit& visit) const {
  std::size_t i = 0;
  for_each_triangle(from_, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    visit((fine[a] + fine[b] + fine[c]) / 3, coarse_at_centroid_[i++]);
  });
}

/// A threshold for the coarse alpha. The coarse cut-out differs from the fine one at `wrong`
/// centroids.
struct LatticeProjection::Cut {
  float level = alpha_threshold;
  std::size_t wrong = 0;
};

LatticeProjection::Cut LatticeProjection::best_cut(std::span<const float> fine,
                                                   std::span<const float> coarse) const {
  struct Sample {
    float value;
    bool covered;
  };
  std::vector<Sample> samples;
  samples.reserve(coarse_at_centroid_.size());
  std::size_t wrong = 0;  // for a threshold below all values, i.e. a fully covered face
  for_each_centroid(fine, [&](float alpha, const Weighted& at) {
    float value = 0;
    for (int k = 0; k < 3; ++k) value += at.weights[k] * coarse[at.texels[k]];
    const bool covered = alpha >= alpha_threshold;
    wrong += covered ? 0 : 1;
    samples.push_back({value, covered});
  });
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) {
    return a.value != b.value ? a.value < b.value : a.covered < b.covered;
  });
  Cut best{samples.front().value - 1, wrong};
  // Tries a threshold between each pair of different values. Among equally good ones, the nearest
  // to 1/2 wins.
  for (std::size_t i = 0; i < samples.size(); ++i) {
    wrong = samples[i].covered ? wrong + 1 : wrong - 1;
    const bool last = i + 1 == samples.size();
    if (!last && samples[i + 1].value == samples[i].value) continue;
    // alpha_threshold if it lies in the gap, else the middle of the gap.
    const float above = last ? samples[i].value + 1 : samples[i + 1].value;
    const bool holds_half = samples[i].value < alpha_threshold && alpha_threshold <= above;
    const float level = holds_half ? alpha_threshold : (samples[i].value + above) / 2;
    if (!(level > samples[i].value)) continue;  // no float lies between the two values
    if (wrong < best.wrong || (wrong == best.wrong && std::abs(level - alpha_threshold) <
                                                          std::abs(best.level - alpha_threshold)))
      best = {level, wrong};
  }
  return best;
}

double LatticeProjection::project_alpha(std::span<const float> fine,
                                        std::span<float> coarse) const {
  const auto [lowest, highest] = std::minmax_element(fine.begin(), fine.end());
  if (*lowest >= alpha_threshold || *highest < alpha_threshold) {
    std::fill(coarse.begin(), coarse.end(), *lowest >= alpha_threshold ? 1.0f : 0.0f);
    return 0;
  }
  if (from_ == to_) {
    std::copy(fine.begin(), fine.end(), coarse.begin());
    return 0;
  }
  project(1, fine, coarse);
  Cut cut = best_cut(fine, coarse);

  // An alpha far from the threshold has no information about the edge, so it is clamped. A reach of
  // 1/8 keeps the slope that locates the edge between two texels.
  constexpr float reach = 0.125f;
  std::vector<float> near_edge(fine.begin(), fine.end()), sharp(coarse.size());
  for (float& alpha : near_edge)
    alpha = std::clamp(alpha, alpha_threshold - reach, alpha_threshold + reach);
  project(1, near_edge, sharp);
  if (const Cut sharp_cut = best_cut(fine, sharp); sharp_cut.wrong < cut.wrong) {
    cut = sharp_cut;
    std::copy(sharp.begin(), sharp.end(), coarse.begin());
  }

  float extent = 0;
  for (float& alpha : coarse) {
    alpha -= cut.level;
    extent = std::max(extent, std::abs(alpha));
  }
  const float scale = extent > alpha_threshold ? alpha_threshold / extent : 1.0f;
  for (float& alpha : coarse) alpha = std::clamp(alpha_threshold + scale * alpha, 0.0f, 1.0f);
  return double(cut.wrong) / double(coarse_at_centroid_.size());
}

double LatticeProjection::coverage_mismatch(std::span<const float> fine,
                                            std::span<const float> coarse) const {
  std::size_t wrong = 0;
  for_each_centroid(fine, [&](float alpha, const Weighted& at) {
    float value = 0;
    for (int k = 0; k < 3; ++k) value += at.weights[k] * coarse[at.texels[k]];
    wrong += (alpha >= alpha_threshold) != (value >= alpha_threshold) ? 1 : 0;
  });
  return double(wrong) / double(coarse_at_centroid_.size());
}

}  // namespace tureen
