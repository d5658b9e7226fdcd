#include "formats/dataset/lens.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

namespace tureen {

namespace {

using Coefficients = std::span<const double>;

double squared_length(glm::dvec2 point) { return glm::dot(point, point); }

/// 1 + c[0] s + c[1] s^2 + ..
double polynomial(Coefficients c, double s) {
  double sum = 0;
  for (std::size_t i = c.size(); i > 0; --i) sum = s * (c[i - 1] + sum);
  return 1 + sum;
}

/// The tangential terms: 2 p1 x y + p2 (r^2 + 2 x^2), and with x and y, p1 and p2 exchanged.
glm::dvec2 tangential(glm::dvec2 p, double p1, double p2) {
  const double r2 = squared_length(p);
  return {2 * p1 * p.x * p.y + p2 * (r2 + 2 * p.x * p.x),
          2 * p2 * p.x * p.y + p1 * (r2 + 2 * p.y * p.y)};
}

glm::dvec2 by_brown(Coefficients c, glm::dvec2 point) {
  const double r2 = squared_length(point);
  const double above[] = {c[0], c[1], c[4]}, below[] = {c[5], c[6], c[7]};
  return point * (polynomial(above, r2) / polynomial(below, r2)) + tangential(point, c[2], c[3]);
}

/// (x, y) theta / r.
glm::dvec2 by_angle(glm::dvec2 point) {
  const double r = glm::length(point);
  return r == 0 ? point : point * (std::atan(r) / r);
}

glm::dvec2 by_fisheye(Coefficients c, glm::dvec2 point) {
  const glm::dvec2 angle = by_angle(point);
  return angle * polynomial(c.first(4), squared_length(angle));
}

glm::dvec2 by_fov(Coefficients c, glm::dvec2 point) {
  const double r = glm::length(point), slope = 2 * std::tan(c[0] / 2);
  return point * (r == 0 ? slope / c[0] : std::atan(r * slope) / (r * c[0]));
}

glm::dvec2 by_thin_prism(Coefficients c, glm::dvec2 point) {
  const glm::dvec2 angle = by_angle(point);
  const double r2 = squared_length(angle), radial[] = {c[0], c[1], c[4], c[5]};
  return angle * polynomial(radial, r2) + tangential(angle, c[2], c[3]) +
         r2 * glm::dvec2(c[6], c[7]);
}

glm::dvec2 by_rad_tan_thin_prism(Coefficients c, glm::dvec2 point) {
  const glm::dvec2 angle = by_angle(point);
  const glm::dvec2 radial = angle * polynomial(c.first(6), squared_length(angle));
  const double r2 = squared_length(radial);
  // Its p0 is p2 of OpenCV.
  return radial + tangential(radial, c[7], c[6]) +
         glm::dvec2(r2 * (c[8] + c[9] * r2), r2 * (c[10] + c[11] * r2));
}

glm::dvec2 by_division(Coefficients c, glm::dvec2 point) {
  // The smaller root of k r r'^2 - r' + r = 0; NaN where there is none.
  return point * (2 / (1 + std::sqrt(1 - 4 * c[0] * squared_length(point))));
}

glm::dvec2 by_eucm(Coefficients c, glm::dvec2 point) {
  return point / (c[0] * std::sqrt(c[1] * squared_length(point) + 1) + 1 - c[0]);
}

}  // namespace

const LensModel brown_model{"FULL_OPENCV", 8, by_brown};
const LensModel fisheye_model{"OPENCV_FISHEYE", 4, by_fisheye, true};
const LensModel fov_model{"FOV", 1, by_fov};
const LensModel thin_prism_model{"THIN_PRISM_FISHEYE", 8, by_thin_prism, true};
const LensModel rad_tan_thin_prism_model{"RAD_TAN_THIN_PRISM_FISHEYE", 12, by_rad_tan_thin_prism,
                                         true};
const LensModel division_model{"DIVISION", 1, by_division};
const LensModel eucm_model{"EUCM", 2, by_eucm};

Lens lens_of(const LensModel& model, Coefficients coefficients) {
  assert(coefficients.size() <= model.coefficients);
  Lens lens{.model = &model};
  std::ranges::copy(coefficients, lens.coefficients.begin());
  // Without its first coefficient, EUCM is a pinhole; the others need all to be 0.
  const auto first = &model == &eucm_model ? coefficients.first(1) : coefficients;
  const bool is_plain = std::ranges::all_of(first, [](double c) { return c == 0; });
  return is_plain && !model.is_fisheye ? Lens{} : lens;
}

Lens brown(const LensNumbers& n) {
  return lens_of(brown_model, std::array{n.k1, n.k2, n.p1, n.p2, n.k3, n.k4, n.k5, n.k6});
}

Lens fisheye(const LensNumbers& n) {
  return lens_of(fisheye_model, std::array{n.k1, n.k2, n.k3, n.k4});
}

glm::dvec2 Lens::distorted(glm::dvec2 point) const {
  return model ? model->distorted(coefficients, point) : point;
}

bool Lens::sees(glm::dvec2 point) const {
  if (!model) return true;
  // The image folds where the Jacobian has no positive determinant and trace. The first such place
  // may lie anywhere between the axis and the point. The polynomials change direction a few times,
  // so a few steps find it.
  constexpr int steps = 16;
  // Balances the errors of the third derivative and of rounding, 1e-10 each.
  constexpr double h = 1e-5;
  for (int i = 1; i <= steps; ++i) {
    const glm::dvec2 at = point * (double(i) / steps);
    const double step = h * (1 + glm::length(at));
    const auto slope = [&](glm::dvec2 along) {
      return (distorted(at + step * along) - distorted(at - step * along)) / (2 * step);
    };
    const glm::dvec2 by_x = slope({1, 0}), by_y = slope({0, 1});
    if (!(by_x.x * by_y.y - by_x.y * by_y.x > 0 && by_x.x + by_y.y > 0)) return false;
  }
  return true;
}

namespace {

/// E. Catmull and R. Rom, "A class of local interpolating splines", 1974: the weights of the
/// samples at -1, 0, 1, 2 for a place `t` in [0, 1] between the middle two.
std::array<float, 4> catmull_rom(float t) {
  const float t2 = t * t, t3 = t2 * t;
  return {0.5f * (-t3 + 2 * t2 - t), 0.5f * (3 * t3 - 5 * t2 + 2), 0.5f * (-3 * t3 + 4 * t2 + t),
          0.5f * (t3 - t2)};
}

/// The four pixels along one axis that an interpolation reads, and their weights.
struct Taps {
  int first = 0;  // from -2 up to the side + 1: the edge repeats there
  std::array<float, 4> weights{};
};

Taps taps(double place, int side) {
  // Far outside, a cast to int would be undefined; such places and NaN use the edge.
  const double at = (place > 0 ? std::min(place, double(side)) : 0.0) + 0.5;
  const int left = int(at);
  return {left - 2, catmull_rom(float(at - left))};
}

/// Interpolates a photograph between its pixels. Outside, the nearest edge pixel repeats.
class Sampler {
 public:
  explicit Sampler(const Image8& photograph)
      : width_(photograph.width),
        height_(photograph.height),
        stride_(std::size_t(width_) + 2 * border),
        pixels_(stride_ * (std::size_t(height_) + 2 * border)) {
    glm::vec4* next = pixels_.data();
    for (int y = -border; y < height_ + border; ++y)
      for (int x = -border; x < width_ + border; ++x) {
        const glm::u8vec4& pixel =
            photograph.at(std::clamp(x, 0, width_ - 1), std::clamp(y, 0, height_ - 1));
        *next++ = float(pixel.a) * glm::vec4(pixel.r, pixel.g, pixel.b, 1.0f);
      }
  }

  /// Writes colour times alpha, and alpha, at a place in pixels (centres at one half) to `sums`.
  /// Compilers vectorise the four channels because the sums go to memory.
  void operator()(glm::dvec2 place, float* sums) const {
    const auto [left, columns] = taps(place.x, width_);
    const auto [top, rows] = taps(place.y, height_);
    const float* pixels =
        &pixels_[std::size_t(top + border) * stride_ + std::size_t(left + border)].x;
    const float* row[4];
    for (std::size_t j = 0; j < 4; ++j) row[j] = pixels + 4 * j * stride_;
    for (std::size_t c = 0; c < 4; ++c) {
      float sum = 0.0f;
      for (std::size_t j = 0; j < 4; ++j)
        sum += rows[j] * (columns[0] * row[j][c] + columns[1] * row[j][c + 4] +
                          columns[2] * row[j][c + 8] + columns[3] * row[j][c + 12]);
      sums[c] = sum;
    }
  }

 private:
  static constexpr int border = 2;  // pixels that the cubic reaches beyond the edge
  int width_, height_;
  std::size_t stride_;
  std::vector<glm::vec4> pixels_;  // colour times alpha, and alpha, both in bytes
};

glm::u8vec4 to_pixel(glm::vec4 sum) {
  // Below half of the smallest positive alpha; the cubic may also be negative.
  if (!(sum.a >= 0.5f)) return glm::u8vec4(0);
  const auto byte = [](float value) { return glm::u8(std::clamp(value, 0.0f, 255.0f) + 0.5f); };
  return {byte(sum.r / sum.a), byte(sum.g / sum.a), byte(sum.b / sum.a), byte(sum.a)};
}

/// A rectangle without unknown pixels. The side with the largest fraction of unknown pixels loses
/// its row or column, until no side has any. Unknown pixels lie outside a curve around the axis, so
/// the sides find them all; known_pixels() verifies this.
class Crop {
 public:
  Crop(const std::vector<bool>& known, int width, int height) : known_(known), width_(width) {
    area_ = {0, 0, width, height};
    while (area_.left < area_.right && area_.top < area_.bottom) {
      const std::array<double, 4> unknown{part_of_column(area_.left),
                                          part_of_column(area_.right - 1), part_of_row(area_.top),
                                          part_of_row(area_.bottom - 1)};
      const auto worst = std::max_element(unknown.begin(), unknown.end());
      if (*worst == 0) break;
      switch (worst - unknown.begin()) {
        case 0:
          ++area_.left;
          break;
        case 1:
          --area_.right;
          break;
        case 2:
          ++area_.top;
          break;
        default:
          --area_.bottom;
      }
    }
  }

  /// Empty if the rectangle has less than half of the image or contains an unknown pixel.
  PixelRectangle known_pixels() const {
    const std::size_t area =
        std::size_t(area_.right - area_.left) * std::size_t(area_.bottom - area_.top);
    if (area < known_.size() / 2) return {};
    for (int y = area_.top; y < area_.bottom; ++y)
      for (int x = area_.left; x < area_.right; ++x)
        if (!at(x, y)) return {};
    return area_;
  }

 private:
  bool at(int x, int y) const {
    return known_[std::size_t(y) * std::size_t(width_) + std::size_t(x)];
  }
  double part_of_column(int x) const {
    int unknown = 0;
    for (int y = area_.top; y < area_.bottom; ++y) unknown += !at(x, y);
    return double(unknown) / (area_.bottom - area_.top);
  }
  double part_of_row(int y) const {
    int unknown = 0;
    for (int x = area_.left; x < area_.right; ++x) unknown += !at(x, y);
    return double(unknown) / (area_.right - area_.left);
  }

  const std::vector<bool>& known_;
  int width_;
  PixelRectangle area_;
};

/// Whether every pixel is visible. The visible region is star-shaped around the axis, so a check of
/// the border is sufficient.
bool sees_all(const Camera& camera, const Lens& lens) {
  const auto sees = [&](double x, double y) {
    return lens.sees({(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy});
  };
  for (int x = 0; x <= camera.width; ++x)
    if (!sees(x, 0) || !sees(x, camera.height)) return false;
  for (int y = 0; y <= camera.height; ++y)
    if (!sees(0, y) || !sees(camera.width, y)) return false;
  return true;
}

}  // namespace

Undistorted undistorted(const Image8& photograph, const Camera& camera, const Lens& lens) {
  const int width = photograph.width, height = photograph.height;
  assert(width == camera.width && height == camera.height && !photograph.pixels.empty());
  Undistorted result;
  result.image = Image8(width, height);
  std::vector<bool> known(photograph.pixels.size());
  const Sampler sample(photograph);
  const bool all_seen = sees_all(camera, lens);
  const glm::dvec2 focal(camera.fx, camera.fy), center(camera.cx, camera.cy);
  std::vector<glm::vec4> sums(static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::dvec2 point = (glm::dvec2(x + 0.5, y + 0.5) - center) / focal;
      const glm::dvec2 place = lens.distorted(point) * focal + center;
      sample(place, &sums[std::size_t(x)].x);
      known[std::size_t(y) * std::size_t(width) + std::size_t(x)] =
          place.x >= 0 && place.x <= width && place.y >= 0 && place.y <= height &&
          (all_seen || lens.sees(point));
    }
    for (int x = 0; x < width; ++x) {
      glm::u8vec4& pixel = result.image.at(x, y);
      pixel = to_pixel(sums[std::size_t(x)]);
      if (!known[std::size_t(y) * std::size_t(width) + std::size_t(x)]) pixel.a = 0;
    }
  }
  result.known = Crop(known, width, height).known_pixels();
  return result;
}

std::vector<std::uint8_t> undistorted_marks(const std::vector<std::uint8_t>& marked,
                                            const Camera& camera, const Lens& lens) {
  const int width = camera.width, height = camera.height;
  assert(marked.size() == std::size_t(width) * std::size_t(height));
  const glm::dvec2 focal(camera.fx, camera.fy), center(camera.cx, camera.cy);
  const auto reads_marked = [&](const Taps& columns, const Taps& rows) {
    for (int j = 0; j < 4; ++j) {
      const auto row = std::size_t(std::clamp(rows.first + j, 0, height - 1)) * std::size_t(width);
      for (int i = 0; i < 4; ++i)
        if (columns.weights[std::size_t(i)] != 0 && rows.weights[std::size_t(j)] != 0 &&
            marked[row + std::size_t(std::clamp(columns.first + i, 0, width - 1))])
          return true;
    }
    return false;
  };
  std::vector<std::uint8_t> result;
  result.reserve(marked.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec2 point = (glm::dvec2(x + 0.5, y + 0.5) - center) / focal;
      const glm::dvec2 place = lens.distorted(point) * focal + center;
      result.push_back(reads_marked(taps(place.x, width), taps(place.y, height)));
    }
  return result;
}

}  // namespace tureen
