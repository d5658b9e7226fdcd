#include "scene/edit/feature_sensitivity.hpp"

#include <algorithm>
#include <cassert>
#include <glm/geometric.hpp>
#include <iterator>
#include <numeric>
#include <random>

#include "scene/lattice.hpp"

namespace tureen {

namespace {

constexpr int features = LatticeTexture::features;
using Features = std::array<double, features>;

/// Random texels of a soup and the colour of their features.
class Sampler {
 public:
  Sampler(const TriangleSoup& soup, std::span<const glm::dvec3> eyes,
          std::span<const double> shown = {})
      : soup_(soup), texture_(std::get<LatticeTexture>(soup.appearance)), eyes_(eyes) {
    assert(!eyes.empty());
    assert(shown.empty() || shown.size() == soup.triangles.size());
    std::partial_sum(shown.begin(), shown.end(), std::back_inserter(shown_until_));
  }

  std::size_t random_face() {
    if (shown_until_.empty()) return below(soup_.triangles.size());
    const double at = double(engine_()) * 0x1p-32 * shown_until_.back();
    const auto face = std::upper_bound(shown_until_.begin(), shown_until_.end(), at);
    // `at` may round up to the total.
    return std::min(std::size_t(face - shown_until_.begin()), shown_until_.size() - 1);
  }
  std::size_t random_texel(std::size_t face) {
    const LatticePatch& patch = texture_.patches[face];
    return patch.first_texel + below(lattice::texel_count(int(patch.level)));
  }
  bool is_visible(std::size_t texel) const {
    return texture_.value(texel, LatticeTexture::features) >= alpha_threshold;
  }
  Features features_of(std::size_t texel) const {
    Features result;
    for (int f = 0; f < features; ++f) result[std::size_t(f)] = double(texture_.value(texel, f));
    return result;
  }
  /// The unit direction from the face's centroid to a random eye.
  glm::dvec3 random_direction(std::size_t face) {
    glm::dvec3 middle(0.0);
    for (int k = 0; k < 3; ++k)
      middle += glm::dvec3(soup_.positions[soup_.triangles[face][k]]) / 3.0;
    const glm::dvec3 way = eyes_[below(eyes_.size())] - middle;
    const double length = glm::length(way);
    // Any direction is valid if the eye is at the centroid or the centroid is not finite.
    return length > 0 && length < 1e300 ? way / length : glm::dvec3(0, 0, 1);
  }
  glm::dvec3 color(const Features& of, const glm::dvec3& to_eye) const {
    if (!texture_.mlp) return {of[0], of[1], of[2]};
    return evaluate(*texture_.mlp, of, to_eye);
  }

 private:
  /// A random number below n. Standard distributions differ between libraries.
  std::size_t below(std::size_t n) { return std::size_t(engine_()) % n; }

  const TriangleSoup& soup_;
  const LatticeTexture& texture_;
  std::span<const glm::dvec3> eyes_;
  std::vector<double> shown_until_;  // running sum of `shown`, including each face
  std::mt19937 engine_{1};
};

}  // namespace

FeatureMatrix mean_sensitivity(const TriangleSoup& soup, std::span<const glm::dvec3> eyes,
                               std::span<const double> shown, int samples) {
  FeatureMatrix sum{};
  if (soup.triangles.empty()) return sum;
  Sampler sampler(soup, eyes, shown);
  // Half the width of the central difference: about the error of features in a compressed file. The
  // network is nonlinear, so a difference of this size predicts the loss better than a derivative.
  constexpr double reach = 12.0 / 255.0;
  int count = 0;
  for (int i = 0; i < samples; ++i) {
    const std::size_t face = sampler.random_face();
    const std::size_t texel = sampler.random_texel(face);
    if (!sampler.is_visible(texel)) continue;
    const glm::dvec3 to_eye = sampler.random_direction(face);
    const Features middle = sampler.features_of(texel);
    std::array<glm::dvec3, features> slopes;
    for (std::size_t f = 0; f < features; ++f) {
      Features low = middle, high = middle;
      low[f] = std::max(0.0, middle[f] - reach);
      high[f] = std::min(1.0, middle[f] + reach);
      slopes[f] = (sampler.color(high, to_eye) - sampler.color(low, to_eye)) / (high[f] - low[f]);
    }
    for (std::size_t a = 0; a < features; ++a)
      for (std::size_t b = 0; b < features; ++b) sum[a][b] += glm::dot(slopes[a], slopes[b]);
    ++count;
  }
  if (count > 0)
    for (auto& row : sum)
      for (double& value : row) value /= count;
  return sum;
}

std::vector<double> face_sensitivity(const TriangleSoup& soup, std::span<const glm::dvec3> eyes,
                                     std::span<const std::array<double, features>> steps) {
  constexpr int samples = 8;  // per face; 15,000 faces take a few seconds
  Sampler sampler(soup, eyes);
  std::vector<double> result(soup.triangles.size(), 0.0);
  for (std::size_t face = 0; face < result.size(); ++face)
    for (int i = 0; i < samples; ++i) {
      const Features middle = sampler.features_of(sampler.random_texel(face));
      const glm::dvec3 to_eye = sampler.random_direction(face);
      for (const Features& step : steps) {
        Features low, high;
        for (std::size_t f = 0; f < features; ++f) {
          low[f] = std::clamp(middle[f] - step[f] / 2, 0.0, 1.0);
          high[f] = std::clamp(middle[f] + step[f] / 2, 0.0, 1.0);
        }
        const glm::dvec3 moved = sampler.color(high, to_eye) - sampler.color(low, to_eye);
        result[face] += glm::dot(moved, moved) / samples;
      }
    }
  return result;
}

}  // namespace tureen
