// The pattern on the porcelain: cobalt blue brush strokes under a clear glaze, and gilded rims.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "examples/noise.hpp"
#include "examples/paints.hpp"

namespace tureen::example {
namespace {

using std::numbers::pi;
constexpr double soft = 0.017;  // about a pixel in an image with 400 pixels a side
constexpr double gloss = 0.6;

const glm::dvec3 white(0.80, 0.79, 0.755), cobalt_deep(0.012, 0.035, 0.20),
    cobalt_thin(0.075, 0.16, 0.47), gold(0.80, 0.54, 0.17);

/// A brush on white. Where strokes overlap, the strongest is visible.
class Brush {
 public:
  /// `distance` < 0 is inside. A filled form is darker near its outline, like dried paint.
  void fill(double distance, double strength = 0.62) {
    const double cover = 1 - glm::smoothstep(-soft, soft, distance);
    const double rim = glm::smoothstep(-0.050, -0.010, distance);
    ink_ = std::max(ink_, cover * glm::mix(strength, 1.0, rim));
  }
  void line(double distance, double half_width) {
    const double cover =
        1 - glm::smoothstep(half_width - soft, half_width + soft, std::abs(distance));
    ink_ = std::max(ink_, cover);
  }
  /// Removes the paint inside.
  void spare(double distance) { ink_ *= glm::smoothstep(-soft, soft, distance); }

  void gild(double distance, double half_width) {
    gilt_ = std::max(gilt_,
                     1 - glm::smoothstep(half_width - soft, half_width + soft, std::abs(distance)));
  }

  Paint dried(double shade) const {
    const double strength = ink_ * (0.86 + 0.14 * shade);
    const glm::dvec3 blue = glm::mix(cobalt_thin, cobalt_deep, glm::smoothstep(0.5, 1.0, strength));
    const glm::dvec3 painted = glm::mix(white, blue, std::min(1.0, strength * 1.35));
    return {.albedo = glm::mix(painted, gold, gilt_), .gloss = gloss};
  }

 private:
  double ink_ = 0, gilt_ = 0;
};

void rosette(Brush& brush, glm::dvec2 p, double radius, int petals) {
  const double r = glm::length(p), angle = std::atan2(p.y, p.x);
  const double lobe = std::abs(std::cos(0.5 * petals * angle));
  brush.fill(r - radius * (0.62 + 0.38 * std::sqrt(lobe)), 0.5);
  brush.spare(std::abs(r - 0.36 * radius) - 0.010);
  brush.fill(r - 0.2 * radius, 1);
}

/// A leaf from `root` in the direction `angle`.
void sprig(Brush& brush, glm::dvec2 p, glm::dvec2 root, double angle, double length) {
  const glm::dvec2 d = p - root, axis(std::cos(angle), std::sin(angle));
  const double along = glm::dot(d, axis) / length;
  const double across = d.y * axis.x - d.x * axis.y;
  if (along < -0.2 || along > 1.2) return;
  const double t = std::clamp(along, 0.0, 1.0);
  const double beyond = std::max({0.0, -along, along - 1}) * length;
  brush.fill(std::max(std::abs(across) - 0.25 * length * std::sin(pi * std::pow(t, 0.8)), beyond),
             0.72);
}

/// Pointed arches that hang from y = 0 towards -y.
void arches(Brush& brush, double u, double y, int count, double circumference, double height) {
  const double each = circumference / count;
  const double x = wrapped(u * count) * each;
  const double depth = height * (1 - std::pow(std::abs(2 * x / each), 1.6));
  if (y > soft) return;
  brush.fill(-y - depth, 0.40);
  brush.spare(std::hypot(x, (y + 0.36 * height) * 0.8) - 0.22 * std::min(each, height));
  brush.fill(std::hypot(x, (y + 0.36 * height) * 0.8) - 0.10 * std::min(each, height), 1);
}

void dots(Brush& brush, double u, double y, int count, double circumference, double radius) {
  brush.fill(std::hypot(wrapped(u * count) * circumference / count, y) - radius, 1);
}

/// A vine around the vessel: a wavy stem with a flower in every bend.
void vine(Brush& brush, double u, double y, int waves, double circumference, double height) {
  const double wave = circumference / waves;
  const double x = wrapped(u * waves) * wave;
  const double phase = 2 * pi * x / wave;
  const double slope = height * 2 * pi / wave * std::cos(phase);
  brush.line((y - height * std::sin(phase)) / std::hypot(1.0, slope), 0.012);
  // Leaves and flowers extend into the neighbouring waves.
  for (const double shift : {-wave, 0.0, wave}) {
    const glm::dvec2 p(x + shift, y);
    const double quarter = wave / 4;
    for (const double side : {-1.0, 1.0}) {
      const glm::dvec2 bend(side * quarter, side * height);
      for (const double k : {-0.62, -0.22, 0.22, 0.62}) {
        const double at = side * quarter + k * quarter;
        const glm::dvec2 root(at, height * std::sin(2 * pi * at / wave));
        sprig(brush, p, root, side * (pi / 2) * (1 - 0.9 * k), 0.115);
      }
      const glm::dvec2 flower = bend - glm::dvec2(0, side * (height + 0.055));
      brush.spare(glm::length(p - flower) - 0.150);
      rosette(brush, p - flower, side > 0 ? 0.135 : 0.125, side > 0 ? 6 : 8);
    }
  }
}

double shade(glm::dvec2 uv) { return fractal_noise({uv.x * 60, uv.y * 14}, 2, 9); }

}  // namespace

Paint tureen_body(glm::dvec2 uv, Turned m) {
  Brush brush;
  const double y = uv.y * m.length;
  arches(brush, uv.x, -(y - 0.05), 20, m.circumference * 0.62, 0.26);
  brush.line(y - 0.04, 0.014);
  vine(brush, uv.x, y - 0.60 * m.length, 6, m.circumference, 0.105);
  brush.line(y - (m.length - 0.205), 0.012);
  dots(brush, uv.x, y - (m.length - 0.145), 60, m.circumference * 0.92, 0.020);
  brush.line(y - (m.length - 0.085), 0.012);
  brush.gild(y - m.length + 0.005, 0.026);
  return brush.dried(shade(uv));
}

Paint tureen_lid(glm::dvec2 uv, Turned m) {
  Brush brush;
  const double y = uv.y * m.length;  // 0 at the rim
  brush.gild(y - 0.035, 0.030);
  brush.line(y - 0.115, 0.012);
  arches(brush, uv.x, -(y - 0.135), 24, m.circumference * 0.86, 0.20);
  const double flowers = 0.56 * m.length;
  const double around = m.circumference * 0.62;
  const double each = around / 6;
  const glm::dvec2 p(wrapped(uv.x * 6) * each, y - flowers);
  for (const double side : {-1.0, 1.0})
    for (const double angle : {0.0, 0.55})
      sprig(brush, p, {side * 0.125, 0.0}, side > 0 ? angle : pi - angle, 0.15);
  brush.spare(glm::length(p) - 0.130);
  rosette(brush, p, 0.125, 6);
  brush.line(y - (m.length - 0.245), 0.011);
  dots(brush, uv.x, y - (m.length - 0.185), 18, m.circumference * 0.22, 0.019);
  brush.gild(y - (m.length - 0.04), 0.030);
  return brush.dried(shade(uv));
}

Paint tureen_foot(glm::dvec2 uv, Turned m) {
  Brush brush;
  const double y = uv.y * m.length;
  brush.gild(y - 0.03, 0.024);
  brush.line(y - 0.10, 0.013);
  arches(brush, uv.x, y - m.length + 0.05, 20, m.circumference * 0.8, 0.12);
  brush.line(y - m.length + 0.04, 0.013);
  return brush.dried(shade(uv));
}

Paint tureen_knob(glm::dvec2 uv, Turned m) {
  Brush brush;
  const double y = uv.y * m.length;
  brush.gild(y - 0.26 * m.length, 0.022);
  if (uv.y > 0.33) {
    const double ray = std::abs(wrapped(uv.x * 8)) / 8 * m.circumference;
    const double t = (uv.y - 0.33) / 0.60;
    brush.fill(ray - 0.036 * std::sqrt(std::max(0.0, std::sin(pi * std::min(1.0, t)))), 0.6);
  }
  brush.gild(y - m.length, 0.035);
  return brush.dried(shade(uv));
}

Paint tureen_handle(glm::dvec2 uv) {
  Brush brush;
  const double around = std::abs(wrapped(uv.x)) * 0.48;
  const double taper = std::sqrt(std::max(0.0, std::sin(pi * std::clamp(uv.y, 0.0, 1.0))));
  brush.fill(around - 0.048 * taper, 0.55);
  brush.gild((0.5 - std::abs(uv.y - 0.5)) * 1.3 - 0.13, 0.022);
  return brush.dried(shade(uv));
}

Paint platter(glm::dvec2 uv, Turned m) {
  Brush brush;
  // y is 0 at the rim, in the middle of the profile, and positive inside.
  const double y = (uv.y - 0.5) * m.length;
  brush.gild(y, 0.030);
  brush.line(y - 0.075, 0.012);
  arches(brush, uv.x, -(y - 0.10), 36, m.circumference * 0.95, 0.17);
  dots(brush, uv.x, y - 0.315, 36, m.circumference * 0.8, 0.021);
  brush.line(y - 0.375, 0.012);
  return brush.dried(shade(uv));
}

}  // namespace tureen::example
