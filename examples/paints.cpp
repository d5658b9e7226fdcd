#include "examples/paints.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>

#include "examples/noise.hpp"

namespace tureen::example {
namespace {

using std::numbers::pi;

const glm::dvec3 green_dark(0.028, 0.085, 0.022), green_light(0.16, 0.27, 0.06);

/// 1 inside (distance < 0), 0 outside, with a border of width `soft` on either side.
double inside(double distance, double soft) { return 1 - glm::smoothstep(-soft, soft, distance); }

/// The approximate distance to the outline of a leaf with this length and half width; positive
/// inside.
double leaf_inside(double across, double along, double length, double half_width) {
  const double t = std::clamp(along / length, 0.0, 1.0);
  const double bulge = std::pow(std::sin(pi * std::pow(t, 0.8)), 0.85) * (1 - 0.25 * t) * 1.12;
  const double stalk = t < 0.25 ? 0.013 : 0.0;
  return std::max(half_width * bulge, stalk) - std::abs(across);
}

}  // namespace

Paint wood(glm::dvec3 p) {
  constexpr double plank = 0.46;
  const double row = std::floor(p.z / plank + 0.5);
  const double seam = (0.5 - std::abs(p.z / plank - row)) * plank;  // distance to the next plank
  const auto seed = static_cast<std::uint64_t>(static_cast<std::int64_t>(row) + 1000);
  Random random(seed);
  const double tone = random.uniform(0.82, 1.12), shift = random.uniform(0, 50);
  // Rings of a trunk cut lengthwise: long in x, distorted by low-frequency noise.
  const double bend = fractal_noise({p.x * 0.55 + shift, p.z * 1.3}, 2, seed);
  const double ring = 0.5 + 0.5 * std::sin((p.z * 2.2 + 2.4 * bend + shift) * 9.0);
  const double fibre = fractal_noise({p.x * 1.4 + shift, p.z * 13.0}, 1, seed + 77);
  const glm::dvec3 light(0.50, 0.300, 0.150), dark(0.27, 0.135, 0.058);
  glm::dvec3 albedo = glm::mix(dark, light, 0.30 + 0.42 * ring * ring + 0.30 * fibre) * tone;
  albedo *= 1 - 0.66 * inside(seam - 0.006, 0.032);
  return {.albedo = albedo};
}

Paint lace(glm::dvec2 uv, Turned measure) {
  constexpr int scallops = 40;
  const double each = measure.circumference / scallops;
  const double x = wrapped(uv.x * scallops) * each;
  const double y = (uv.y - 1) * measure.length;  // 0 at the outermost line, negative inwards
  // The border: a row of discs above a straight band.
  const double center = -0.085;
  const double scallop = 0.085 - 0.012 - std::hypot(x, y - center);
  double outside = std::max(scallop, center - y);
  // Holes: one in each scallop, three smaller ones below, a row of slits further in.
  outside = std::min(outside, std::hypot(x, y - center) - 0.034);
  const double x2 = wrapped(uv.x * scallops + 0.5) * each;
  outside = std::min(outside, std::hypot(x2, y - center + 0.062) - 0.027);
  outside = std::min(outside, std::hypot(x, y - center + 0.125) - 0.036);
  outside = std::min(outside, std::hypot(x2, (y - center + 0.195) * 0.75) - 0.030);
  return {.albedo = {0.79, 0.765, 0.71}, .gloss = 0, .hole = outside < 0};
}

Paint lemon_skin(glm::dvec2 uv) {
  const glm::dvec2 p(std::cos(2 * pi * uv.x) * 3, std::sin(2 * pi * uv.x) * 3 + uv.y * 7);
  const double mottle = fractal_noise(p * 2.2, 2, 11);
  const double tip = std::max(glm::smoothstep(0.86, 1.0, uv.y), glm::smoothstep(0.10, 0.0, uv.y));
  const glm::dvec3 ripe =
      glm::mix(glm::dvec3(0.80, 0.47, 0.018), glm::dvec3(0.86, 0.62, 0.05), mottle);
  return {.albedo = glm::mix(ripe, glm::dvec3(0.55, 0.50, 0.06), 0.55 * tip), .gloss = 0.42};
}

Paint lemon_flesh(glm::dvec2 p) {
  constexpr int segments = 9;
  const double r = glm::length(p), angle = std::atan2(p.y, p.x) / (2 * pi);
  const double side = (0.5 - std::abs(wrapped(angle * segments))) / segments * 2 * pi * r;
  // A segment ends before its neighbours' skins, the pith and the middle.
  const double within = std::min({side - 0.028, 0.83 - r, (r - 0.09) * 0.8});
  const double vesicle = fractal_noise({angle * 95, r * 5.5}, 2, 3);
  const glm::dvec3 pith(0.86, 0.80, 0.52), skin(0.80, 0.50, 0.02);
  const glm::dvec3 pulp =
      glm::mix(glm::dvec3(0.78, 0.53, 0.07), glm::dvec3(0.90, 0.74, 0.22), vesicle);
  glm::dvec3 albedo = glm::mix(pith, pulp, glm::smoothstep(-0.02, 0.05, within));
  albedo = glm::mix(albedo, skin, glm::smoothstep(0.93, 0.97, r));
  return {.albedo = albedo, .gloss = 0.30};
}

Paint leaf(glm::dvec2 uv, glm::dvec2 size, std::uint64_t seed) {
  const double across = (uv.x - 0.5) * size.x, along = uv.y * size.y;
  const double outline = leaf_inside(across, along, size.y, 0.46 * size.x);
  const double middle = inside(std::abs(across) - 0.006, 0.012);
  const double rib = std::sin((along + 0.7 * std::abs(across)) * 2 * pi / 0.075);
  const double vein = glm::smoothstep(0.55, 1.0, rib) * 0.25;
  Random random(seed);
  const double tone = random.uniform(0.1, 0.5);
  const double patch = fractal_noise(glm::dvec2(across, along) * 9.0, 2, seed);
  const double light = std::clamp(tone + 0.35 * patch - 0.1, 0.0, 1.0);
  glm::dvec3 albedo = glm::mix(green_dark, green_light, light);
  albedo = glm::mix(albedo, glm::dvec3(0.25, 0.33, 0.10), std::max(0.75 * middle, vein));
  return {.albedo = albedo, .gloss = 0.30, .hole = outline < 0};
}

Paint petal(glm::dvec2 uv, glm::dvec2 size) {
  const double across = (uv.x - 0.5) * size.x, along = uv.y * size.y;
  const double bulge = std::sqrt(std::max(0.0, std::sin(pi * std::pow(uv.y, 1.25))));
  const double outline =
      std::min(0.46 * size.x * bulge - std::abs(across), std::min(along, size.y - along) - 0.002);
  const glm::dvec3 albedo = glm::mix(glm::dvec3(0.78, 0.72, 0.42), glm::dvec3(0.86, 0.83, 0.80),
                                     glm::smoothstep(0.05, 0.45, uv.y));
  return {.albedo = albedo, .gloss = 0, .hole = outline < 0};
}

Paint blossom_heart() { return {.albedo = {0.75, 0.45, 0.04}}; }

Paint bark(glm::dvec2 uv) {
  const double grain = fractal_noise({uv.x * 8, uv.y * 24}, 2, 21);
  return {.albedo = glm::mix(glm::dvec3(0.10, 0.085, 0.03), glm::dvec3(0.20, 0.19, 0.07), grain)};
}

}  // namespace tureen::example
