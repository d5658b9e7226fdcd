// The drawing options that all drawing commands share.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "cli/options/arguments.hpp"
#include "jobs/baseline/baseline.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/plan/plan.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

struct DrawingOptions {
  gl::Backend backend = gl::Backend::automatic;
  PipelineKind pipeline = PipelineKind::tureen;
  PlanPreferences plan = {};
  bool opaque = false;
  std::optional<int> supersampling = {};  // without both, the scene's own quality
  std::optional<double> resolution_scale = {};
  std::optional<Quality::SplatOrder> splat_order = {};  // without, the scene's own
};

/// --splat-order, called with the value. `help` is its description.
Option add_splat_order(Command& command, std::function<void(Quality::SplatOrder)> set,
                       const std::string& help);

/// The plan's preferences for a scene; its quality setting is the default. Prints a sentence for
/// each option that does not apply to the scene.
PlanPreferences preferences_for(const Scene& scene, const DrawingOptions& options);

/// --context. `backend` must live until the arguments are parsed.
void add_context_option(Command& command, gl::Backend& backend);

/// Applies --opaque. Throws as make_opaque.
void apply_opaque(Scene& scene, const DrawingOptions& options);

/// --supersample and --opaque, which all renderers support. `options` must live until the arguments
/// are parsed.
void add_sampling_options(Command& command, DrawingOptions& options);

/// --context, --pipeline, --no-specialise, --keep, --shading, --blend, --splat-order, and those of
/// add_sampling_options().
void add_drawing_options(Command& command, DrawingOptions& options);

/// --scale, after add_drawing_options. Commands whose --scale resizes photographs cannot have it.
void add_drawing_scale(Command& command, DrawingOptions& options);

}  // namespace tureen::cli
