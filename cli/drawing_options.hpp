// How the runtime draws, on the command line: the options that all commands share which draw.
#pragma once

#include <CLI/App.hpp>

#include "runtime/gl/context.hpp"
#include "runtime/plan.hpp"

namespace tureen::cli {

struct DrawingOptions {
  gl::Backend backend = gl::Backend::automatic;
  PlanPreferences plan = {};
};

/// --context, --pipeline, --no-specialise, --keep and --supersample, which makes a preset.
/// `options` must live until the arguments are parsed.
void add_drawing_options(CLI::App& command, DrawingOptions& options);

/// --scale, which makes a preset, too; after add_drawing_options. Not where a dataset's photographs
/// have a --scale of their own.
void add_drawing_scale(CLI::App& command, DrawingOptions& options);

}  // namespace tureen::cli
