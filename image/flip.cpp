#include "image/flip.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <numbers>
#include <numeric>

#include "image/separable_filter.hpp"
#include "image/srgb.hpp"

namespace tureen {

namespace {

using std::numbers::pi;

// --- Colour spaces --------------------------------------------------------------------------

/// linear_from_srgb with a table for the 256 values of 8-bit images. A power per channel would be a
/// large part of the total time.
class Linearise {
 public:
  Linearise() {
    for (int i = 0; i < 256; ++i) table_[i] = linear_from_srgb(double(float(i) / 255.0f));
  }
  double operator()(float value) const {
    if (!(value > 0.0f)) return 0.0;  // also NaN
    if (value >= 1.0f) return 1.0;
    const int nearest = int(value * 255.0f + 0.5f);
    return value == float(nearest) / 255.0f ? table_[nearest] : linear_from_srgb(double(value));
  }

 private:
  std::array<double, 256> table_;
};

/// XYZ / white from linear sRGB: the CIE matrix for sRGB's primaries and D65, from their
/// chromaticities (x, y). Each row is divided by its sum, so white is (1, 1, 1). The authors'
/// program rounds the matrix in the fifth digit, which changes a mean by about 1e-6.
glm::dmat3 relative_xyz_from_rgb() {
  const auto column = [](double x, double y) { return glm::dvec3(x / y, 1.0, (1 - x - y) / y); };
  const glm::dmat3 primaries(column(0.64, 0.33), column(0.30, 0.60), column(0.15, 0.06));
  const glm::dvec3 white = column(0.3127, 0.3290);
  const glm::dvec3 scale = glm::inverse(primaries) * white;
  glm::dmat3 matrix;
  for (int c = 0; c < 3; ++c) matrix[c] = primaries[c] * scale[c] / white;
  return matrix;
}

/// YCxCz, a linearised L*a*b* in which the paper filters (section 4.1).
glm::dvec3 ycxcz_from_relative_xyz(const glm::dvec3& r) {
  return {116 * r.y - 16, 500 * (r.x - r.y), 200 * (r.y - r.z)};
}

glm::dvec3 relative_xyz_from_ycxcz(const glm::dvec3& c) {
  const double y = (c.x + 16) / 116;
  return {y + c.y / 500, y, y - c.z / 200};
}

/// L*a*b* (CIE 15:2004) with a* and b* scaled by L*/100 for the Hunt effect: lighter colours look
/// more colourful (section 4.1).
glm::dvec3 hunt_lab(const glm::dvec3& r) {
  constexpr double delta = 6.0 / 29.0;
  const auto f = [](double t) {
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29.0;
  };
  const double x = f(r.x), y = f(r.y), z = f(r.z);
  const double lightness = 116 * y - 16;
  return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

/// City-block in lightness, Euclidean in chroma (Abasi, Tehran and Fairchild 2020).
double hyab(const glm::dvec3& a, const glm::dvec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// --- The colour pipeline (section 4.1) ------------------------------------------------------

constexpr double color_exponent = 0.7;  // q_c

/// Differences above color_knee times the largest one are compressed into the range from
/// color_knee_value to 1.
constexpr double color_knee = 0.4;         // p_c
constexpr double color_knee_value = 0.95;  // p_t

/// One Gaussian of a contrast sensitivity filter: amplitude * sqrt(pi / spread) *
/// exp(-pi^2 r^2 / spread), r in degrees (Movellan's transform of Johnson and Fairchild's fit).
struct Sensitivity {
  double amplitude, spread;
};
constexpr std::array<Sensitivity, 1> achromatic{{{1.0, 0.0047}}};
constexpr std::array<Sensitivity, 1> red_green{{{1.0, 0.0053}}};
constexpr std::array<Sensitivity, 2> blue_yellow{{{34.1, 0.04}, {13.5, 0.025}}};

/// Filters the plane by contrast sensitivity. A sum of two Gaussians is not separable, so each is
/// applied alone. The weights of all terms sum to 1.
Plane csf_filtered(const Plane& plane, std::span<const Sensitivity> terms,
                   double pixels_per_degree) {
  // Three standard deviations of the widest Gaussian, for every channel.
  const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * pixels_per_degree));
  Plane result(plane.width, plane.height);
  double total = 0;
  for (const Sensitivity& term : terms) {
    const double sigma = std::sqrt(term.spread / (2 * pi * pi)) * pixels_per_degree;
    std::vector<double> rows = gaussian(sigma, radius);
    const std::vector<double> columns = rows;
    const double gain = term.amplitude * std::sqrt(pi / term.spread);
    const double sum = std::accumulate(rows.begin(), rows.end(), 0.0);
    total += gain * sum * sum;
    for (double& weight : rows) weight *= gain;
    const Plane part =
        filter_columns(filter_rows(plane, rows, Border::replicate), columns, Border::replicate);
    for (std::size_t i = 0; i < part.values.size(); ++i) result.values[i] += part.values[i];
  }
  for (double& value : result.values) value /= total;
  return result;
}

struct Prepared {
  std::array<Plane, 3> ycxcz;
};

Prepared prepared(const ImageF& image, const Linearise& linearise, const glm::dmat3& xyz_from_rgb) {
  Prepared result;
  for (Plane& plane : result.ycxcz) plane = Plane(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::vec4& p = image.pixels[i];
    const glm::dvec3 color = ycxcz_from_relative_xyz(
        xyz_from_rgb * glm::dvec3(linearise(p.r), linearise(p.g), linearise(p.b)));
    for (int c = 0; c < 3; ++c) result.ycxcz[c].values[i] = color[c];
  }
  return result;
}

/// The perceived colour of each pixel, as an argument of hyab().
std::vector<glm::dvec3> perceived(const Prepared& image, const glm::dmat3& xyz_from_rgb,
                                  double pixels_per_degree) {
  const Plane y = csf_filtered(image.ycxcz[0], achromatic, pixels_per_degree);
  const Plane cx = csf_filtered(image.ycxcz[1], red_green, pixels_per_degree);
  const Plane cz = csf_filtered(image.ycxcz[2], blue_yellow, pixels_per_degree);
  const glm::dmat3 rgb_from_xyz = glm::inverse(xyz_from_rgb);
  std::vector<glm::dvec3> result(y.values.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const glm::dvec3 rgb =
        rgb_from_xyz * relative_xyz_from_ycxcz({y.values[i], cx.values[i], cz.values[i]});
    // Each channel has its own filter, so the result may lie outside the sRGB gamut.
    result[i] = hunt_lab(xyz_from_rgb * glm::clamp(rgb, glm::dvec3(0.0), glm::dvec3(1.0)));
  }
  return result;
}

// --- The feature pipeline (section 4.2) -----------------------------------------------------

constexpr double feature_width_degrees = 0.082;  // w, the perceived width of an edge
constexpr double feature_exponent = 0.5;         // q_f

/// Scales positive weights to sum 1 and negative ones to sum -1, so that the response to a step or
/// a line of full contrast is 1.
void balance(std::vector<double>& weights) {
  double positive = 0, negative = 0;
  for (const double weight : weights) (weight > 0 ? positive : negative) += weight;
  for (double& weight : weights) weight /= weight > 0 ? positive : -negative;
}

struct EdgesAndPoints {
  std::vector<double> edges, points;  // magnitude of the gradient and of the second derivatives
};

EdgesAndPoints features_of(const Plane& luminance, double pixels_per_degree) {
  const double sigma = 0.5 * feature_width_degrees * pixels_per_degree;
  const int radius = int(std::ceil(3 * sigma));
  std::vector<double> smooth = gaussian(sigma, radius);
  std::vector<double> edge(smooth.size()), point(smooth.size());
  for (int i = 0; i < int(smooth.size()); ++i) {
    const double x = i - radius;
    edge[i] = -x * smooth[i];
    point[i] = (x * x / (sigma * sigma) - 1) * smooth[i];
  }
  // The sign of a weight depends on one coordinate, so balancing that axis balances the product.
  balance(edge);
  balance(point);
  const double sum = std::accumulate(smooth.begin(), smooth.end(), 0.0);
  for (double& weight : smooth) weight /= sum;

  constexpr Border border = Border::replicate;
  const Plane smooth_rows = filter_rows(luminance, smooth, border);
  const auto magnitude = [&](const std::vector<double>& weights) {
    const Plane across = filter_columns(filter_rows(luminance, weights, border), smooth, border);
    const Plane down = filter_columns(smooth_rows, weights, border);
    std::vector<double> result(across.values.size());
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = std::sqrt(across.values[i] * across.values[i] + down.values[i] * down.values[i]);
    return result;
  };
  return {magnitude(edge), magnitude(point)};
}

EdgesAndPoints features_of(const Prepared& image, double pixels_per_degree) {
  Plane luminance = image.ycxcz[0];
  for (double& y : luminance.values) y = (y + 16) / 116;
  return features_of(luminance, pixels_per_degree);
}

}  // namespace

FlipResult flip(const ImageF& reference, const ImageF& test, const FlipOptions& options) {
  assert(reference.width == test.width && reference.height == test.height);
  assert(!reference.pixels.empty() && options.pixels_per_degree > 0);
  const double ppd = options.pixels_per_degree;
  const Linearise linearise;
  const glm::dmat3 xyz_from_rgb = relative_xyz_from_rgb();
  const Prepared a = prepared(reference, linearise, xyz_from_rgb);
  const Prepared b = prepared(test, linearise, xyz_from_rgb);
  const std::vector<glm::dvec3> seen_a = perceived(a, xyz_from_rgb, ppd);
  const std::vector<glm::dvec3> seen_b = perceived(b, xyz_from_rgb, ppd);
  const EdgesAndPoints features_a = features_of(a, ppd), features_b = features_of(b, ppd);

  // Green and blue have the largest difference of all sRGB colours.
  const double largest = std::pow(hyab(hunt_lab(xyz_from_rgb * glm::dvec3(0, 1, 0)),
                                       hunt_lab(xyz_from_rgb * glm::dvec3(0, 0, 1))),
                                  color_exponent);
  const double knee = color_knee * largest;

  FlipResult result;
  result.map.resize(seen_a.size());
  double sum = 0;
  for (std::size_t i = 0; i < seen_a.size(); ++i) {
    const double distance = std::pow(hyab(seen_a[i], seen_b[i]), color_exponent);
    const double color = distance < knee ? color_knee_value / knee * distance
                                         : color_knee_value + (distance - knee) / (largest - knee) *
                                                                  (1 - color_knee_value);
    const double stronger = std::max(std::abs(features_a.edges[i] - features_b.edges[i]),
                                     std::abs(features_a.points[i] - features_b.points[i]));
    const double feature = std::pow(stronger / std::sqrt(2.0), feature_exponent);
    // Rounding may move either factor one ulp outside its range.
    const double error = std::pow(std::min(color, 1.0), 1.0 - std::min(feature, 1.0));
    result.map[i] = float(error);
    sum += error;
  }
  result.mean = sum / double(result.map.size());
  return result;
}

}  // namespace tureen
