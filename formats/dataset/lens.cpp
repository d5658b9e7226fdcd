#include "formats/dataset/lens.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/vec4.hpp>

namespace tureen {

namespace {

/// theta_d(theta) / theta, for a squared angle.
double fisheye_radial(const Lens& lens, double t2) {
  return 1 + t2 * (lens.k1 + t2 * (lens.k2 + t2 * (lens.k3 + t2 * lens.k4)));
}

glm::dvec2 distorted_by_fisheye(const Lens& lens, glm::dvec2 point) {
  const double r = std::hypot(point.x, point.y);
  if (r == 0) return point;
  const double theta = std::atan(r);
  return point * (theta * fisheye_radial(lens, theta * theta) / r);
}

/// Whether theta_d increases from the axis to the point, and stays positive with it.
bool fisheye_sees(const Lens& lens, glm::dvec2 point) {
  const double theta = std::atan(std::hypot(point.x, point.y));
  // The derivative has at most four changes of sign.
  constexpr int steps = 16;
  for (int i = 1; i <= steps; ++i) {
    const double t2 = theta * theta * i * i / (steps * steps);
    const double slope =
        1 + t2 * (3 * lens.k1 + t2 * (5 * lens.k2 + t2 * (7 * lens.k3 + t2 * 9 * lens.k4)));
    if (!(slope > 0)) return false;
  }
  return true;
}

}  // namespace

glm::dvec2 Lens::distorted(glm::dvec2 point) const {
  if (model == LensModel::fisheye) return distorted_by_fisheye(*this, point);
  const double x = point.x, y = point.y, r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + 2 * p2 * x * y + p1 * (r2 + 2 * y * y)};
}

bool Lens::sees(glm::dvec2 point) const {
  if (model == LensModel::fisheye) return fisheye_sees(*this, point);
  // The image folds where the determinant of the Jacobian is not positive. Its radial part
  // along r is 1 + 3 k1 r^2 + 5 k2 r^4 + 7 k3 r^6, whose first root may lie anywhere between the
  // axis and the point. This polynomial changes direction at most three times, so a few steps find
  // the root.
  constexpr int steps = 8;
  for (int i = 1; i <= steps; ++i) {
    const double x = point.x * i / steps, y = point.y * i / steps, r2 = x * x + y * y;
    const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3));  // of radial, by r^2, twice
    const double xx = radial + x * x * slope + 2 * p1 * y + 6 * p2 * x;
    const double yy = radial + y * y * slope + 2 * p2 * x + 6 * p1 * y;
    const double xy = x * y * slope + 2 * p1 * x + 2 * p2 * y;  // the Jacobian is symmetric
    if (!(xx * yy - xy * xy > 0 && xx + yy > 0)) return false;
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
