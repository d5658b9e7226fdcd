#include "trainer/diffsoup/config.hpp"

#include <cassert>

namespace tureen::trainer {

Config preset(Preset kind) {
  Config config;
  config.preset = kind;
  config.max_level = automatic_level;
  if (kind == Preset::scene) {
    // Photographs show walls and trees behind their subject.
    config.far_points = 0.5f;
    config.around_points = 0.3f;
    config.backing_triangles = 80;
    // A face right in front of one camera appears in no other photograph. No loss corrects it, and
    // it spoils the neighbouring views.
    config.near = 0.8f;
    config.clear_near = true;
    config.min_views = 3;
    // Photographs of a scene have no background: a pixel without a triangle is an error. With a
    // white background it would match white walls.
    for (float& channel : config.background) channel = 0.0f;
  } else {
    config.near = 0.1f;
    config.far = 10.0f;
  }
  return config;
}

Config published(Preset kind) {
  Config config = preset(kind);
  config.max_level = 5;
  config.gaussian_steps = 0;
  config.far_points = 0.0f;
  config.backing_triangles = 0;
  config.initial_radius = 0.25f;
  config.lift_at = 0.5f;
  config.lift_keeps_opacity = false;
  config.turnover = 0.0f;
  config.split_by_error = false;
  config.baseline = false;
  config.texture_slide = 1.0f;
  config.dense_updates = true;
  config.reset_moments = true;
  config.resample_textures = false;
  if (kind == Preset::object) {
    config.vertex_rate = 1e-3f;
    // Published: 100,000 random points in a box of half side s = 1.2 .. 2.0, circumradius 0.01. The
    // mean distance to the nearest of n uniform points is 0.554 * 2 s / cbrt(n) (Chandrasekhar
    // 1943): 0.0358 for s = 1.5. 0.01 / 0.0358 = 0.28.
    config.initial_triangles = 100'000;
    config.initial_radius = 0.28f;
  } else {
    config.split_beyond_budget = true;
    config.near = 0.01f;
    config.clear_near = false;
    config.min_views = 1;
    config.around_points = 0.0f;
  }
  return config;
}

Config scaled_to(const Config& config, double half_side) {
  assert(half_side > 0);
  const double factor = half_side / reference_extent;
  Config scaled = config;
  scaled.vertex_rate = float(config.vertex_rate * factor);
  scaled.near = float(config.near * factor);
  scaled.far = float(config.far * factor);
  return scaled;
}

}  // namespace tureen::trainer
