#include "jobs/compress/importance.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "jobs/visibility/visibility_count.hpp"
#include "scene/lattice.hpp"

namespace tureen {

namespace {

/// CompressedTexelOptions::bit_price, in squared steps. Among 0.2, 0.25, 0.3, 0.4 and 0.5 this
/// gives the fewest bytes at the same loss (the fox). If every value took bits, 2 ln 2 / 12 = 0.12
/// would be optimal: the squared error is 1/12 of a squared step, and doubling the step saves a
/// bit.
constexpr double bit_price = 0.3;
/// Exponent of a face's visible pixels and sensitivity, relative to the mean, in its step. The
/// weights account for the rest. Compared with 0 and 0.4 this saves 1 % of the fox's bytes at the
/// same loss.
constexpr double follow = 0.2;
/// Smallest visibility of a texel, relative to the mean, because other views may show more than the
/// recorded ones. Three times this value costs 1.5 % more bytes (the fox).
constexpr double min_shown = 0.01;
/// Step of colour for measuring the sensitivity of faces, about that of the final result.
constexpr double usual_step = 8;

using Features = std::array<double, LatticeTexture::features>;

/// The change of all features by a step along each axis of the basis; features are in [0, 1].
std::vector<Features> steps_of(const CompressedBasis& basis) {
  std::vector<Features> result(basis.rows.size());
  for (std::size_t axis = 0; axis < result.size(); ++axis)
    for (std::size_t f = 0; f < basis.rows.size(); ++f)
      result[axis][f] = double(basis.rows[f][axis]) / 65536.0 * compress_fraction / 255.0;
  return result;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / double(values.size());
}

/// The index of the multiplier whose ratio to `wanted` is nearest to 1.
std::uint8_t nearest_multiplier(double wanted) {
  std::size_t best = 0;
  const auto away = [&](std::size_t i) {
    return std::abs(std::log(compress_multipliers[i] / 4.0 / wanted));
  };
  for (std::size_t i = 1; i < compress_multipliers.size(); ++i)
    if (away(i) < away(best)) best = i;
  return std::uint8_t(best);
}

}  // namespace

CompressImportance::CompressImportance(const gl::Context& context, const TriangleSoup& soup,
                                       glm::dvec3 origin, std::span<const Camera> views,
                                       bool by_texel, const std::function<void()>& cancel)
    : texture_(std::get<LatticeTexture>(soup.appearance)),
      weights_(count_visible_texels(context, soup, origin, views, [&](double) { cancel(); })) {
  std::vector<glm::dvec3> eyes;
  for (const Camera& view : views) eyes.push_back(view.eye() - origin);

  std::vector<double> shown;  // pixels of each face
  double texels = 0;
  for (const LatticePatch& patch : texture_.patches) {
    double pixels = 0;
    for (std::uint32_t i = 0; i < lattice::texel_count(int(patch.level)); ++i)
      pixels += double(weights_[patch.first_texel + i]);
    // Other views may show a face that these do not, so a face counts at least a quarter of a
    // pixel.
    shown.push_back(std::max(pixels, 0.25));
    texels += lattice::texel_count(int(patch.level));
  }
  sensitivity_ = mean_sensitivity(soup, eyes, shown);
  const double mean_shown = mean(shown);
  const double texel_shown = mean_shown * double(shown.size()) / std::max(texels, 1.0);

  const std::vector<double> moved =
      face_sensitivity(soup, eyes, steps_of(compressed_basis(texture_, sensitivity_, usual_step)));
  const double mean_moved = mean(moved);
  if (by_texel) unseen_texels_ = std::size_t(std::count(weights_.begin(), weights_.end(), 0.0f));
  std::vector<float> weights(weights_.size(), 0.0f);
  for (std::size_t t = 0; t < shown.size(); ++t) {
    // The lower limit applies to faces whose colour does not depend on their features.
    const double sees = mean_moved > 0 ? std::max(moved[t] / mean_moved, 1e-3) : 1;
    coarseness_.push_back(nearest_multiplier(1 / std::pow(shown[t] / mean_shown * sees, follow)));
    const LatticePatch& patch = texture_.patches[t];
    for (std::uint32_t i = 0; i < lattice::texel_count(int(patch.level)); ++i) {
      const std::size_t texel = patch.first_texel + i;
      const double visible =
          by_texel ? std::max(double(weights_[texel]) / texel_shown, min_shown) : 1;
      // A texel of several faces gets the weight from the most sensitive one.
      weights[texel] = std::max(weights[texel], float(visible * sees));
    }
  }
  weights_ = std::move(weights);
}

CompressedTexelOptions CompressImportance::options(double step, std::uint8_t alpha_step,
                                                   bool bits_have_a_price) const {
  return {.basis = compressed_basis(texture_, sensitivity_, step, weights_),
          .feature_step = compress_fraction,
          .alpha_step = alpha_step,
          .coarseness = coarseness_,
          .weights = weights_,
          .bit_price = bits_have_a_price ? bit_price : 0};
}

}  // namespace tureen
