// Triangle windows as a method of SplatTrainer (Triangle Splatting, arXiv 2505.19175).
//
// With WindowConfig::opaque, the windows become opaque triangles in the second half of the run:
// their solidity rises. As in Triangle Splatting+ (arXiv 2509.25122, section 3.3), opacity has an
// ever higher floor. There, sigma falls to 1e-4, so that only pixels on an edge move it; here, the
// window becomes a narrow ramp along the edges (splatting/windows/window_plane-inl.hpp), and a
// VarianceLoss accounts for renderings with one sample per pixel. The authors' variant for game
// engines (mean sigma and one over the mean opacity as losses) fixes neither the end nor its time.
//
// Not implemented: the losses of normals and of distortion (weights 1e-4 and 0 for scenes without
// walls).
#pragma once

#include <span>

#include "scene/scene.hpp"
#include "trainer/splats/splat_trainer.hpp"
#include "trainer/splats/windows/window_densify.hpp"
#include "trainer/splats/windows/window_step_kernels.hpp"

namespace tureen::trainer {

struct WindowTraining {
  using Config = WindowConfig;
  using Kernel = splatting::WindowKernel;
  using Parameters = WindowParameters;
  using Moments = WindowMoments;
  using Step = WindowStep;
  static constexpr std::string_view profile = "triangle-splatting";
  static constexpr bool has_variance = true;
  static constexpr const auto& kinds = window_parameter_kinds;
  static constexpr auto tile_functions = &window_tile_functions;
  static constexpr auto step_functions = &window_step_functions;

  /// The constants of a step after the fraction `done` of the run, without the rates.
  static Step step_of(const Config& config, double half_side, double done, std::size_t count);

  /// The densification after `step` steps, the one with this number, from 1 on.
  static DensifyReport densify(const Config& config, int step, int number, Random& random,
                               Parameters& parameters, SplatMemory& memory);

  /// A factor of the rate of corners, which falls to solid_rate.
  static float position_rate(const Parameters& parameters) {
    return 1 - parameters.solidity * (1 - solid_rate);
  }
  /// The edges of soft triangles hardly show. Those of solid ones do, and move in smaller steps.
  /// With photographs of lego at 400x400 that were held back from
  /// training, factors of 3, 1, 0.3 and 0.1 give 25.7, 29.9, 30.4 and 30.3 dB with 4x4 samples.
  static constexpr float solid_rate = 0.3f;

  /// Of VarianceLoss: soft triangles do not cover a part of a pixel, solid ones do.
  static float variance_weight(const Config& config, const Parameters& parameters) {
    return config.variance_weight * parameters.solidity;
  }

  /// Sets the solidity after `step` steps, and moves sigma towards 1.
  static void limit(const Config& config, int step, Parameters& parameters);

  /// The first windows are equilateral triangles with random orientations. A size is their
  /// circumradius, as WindowConfig::first_size says. Coincident points have the size of a single
  /// one.
  static constexpr std::size_t neighbours = 1;
  static double size_of_share(const Config& config, double side) {
    return config.first_size * side;
  }
  static double size_at_point(const Config& config, double distance, double spacing, double);
  static void put(const Config& config, const ColoredPoint& point, double size, Random& random,
                  std::size_t place, Parameters& parameters);

  /// Windows that a viewer can draw: finite, and not too transparent. With WindowConfig::opaque and
  /// a solidity of at least solidity_of_triangles: opaque triangles with the same harmonics,
  /// without those that no view shows; if no view shows any, all. `evident`: the row
  /// splat_statistic::evident if each view was used since the last densification; else empty.
  static Primitives primitives(const Config& config, const Parameters& parameters,
                               std::span<const float> evident);
  /// From this solidity on, a run that ends early and previews have opaque triangles. The middle of
  /// the range; not measured.
  static constexpr float solidity_of_triangles = 0.5f;
};

using WindowTrainer = SplatTrainer<WindowTraining>;

/// Calls act<WindowTraining>().
template <class Act>
decltype(auto) with_training(const WindowConfig&, const Act& act) {
  return act.template operator()<WindowTraining>();
}

/// A window with these corners, first_sigma and first_opacity.
void put_window(const WindowConfig& config, const glm::dvec3 (&corners)[3], const glm::vec3& color,
                std::size_t place, WindowParameters& parameters);

}  // namespace tureen::trainer
