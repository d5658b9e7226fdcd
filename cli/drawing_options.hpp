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

/// --context, --pipeline, --no-specialise and --keep. `options` must live until the arguments are
/// parsed.
void add_drawing_options(CLI::App& command, DrawingOptions& options);

}  // namespace tureen::cli
